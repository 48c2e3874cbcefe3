// A video device of Linux (V4L2) that streams into memory it shares with the program: webcams, capture cards, vivid.
// Source: the kernel's Documentation/userspace-api/media/v4l.
//
// It gives Motion JPEG, which is handed on as it is, or YUYV; Motion JPEG where it can, because that is what USB has
// room for at full rate. The resolution is the description's, exactly; the rate the nearest that the device has.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hrt/camera.hpp"
#include "libkenaf_real/camera_on_robot.hpp"

namespace kenaf::real {

// What of a filled buffer a picture's bytes are. `row_bytes`: from row to row in the buffer, YUYV only. nullopt: it is
// not whole, as it happens with webcams at their start and where USB loses packets.
std::optional<std::vector<std::uint8_t>> bytes_of_buffer(hrt::CameraPicture::Encoding encoding, int width, int height,
                                                         std::size_t row_bytes, std::span<const std::uint8_t> buffer);

class V4l2Camera final : public hrt::Camera {
 public:
  explicit V4l2Camera(CameraOnRobot camera);
  ~V4l2Camera() override;
  V4l2Camera(const V4l2Camera&) = delete;
  V4l2Camera& operator=(const V4l2Camera&) = delete;

  void open() override;
  std::optional<hrt::CameraPicture> next() override;
  void pause() override;  // switches the stream off
  void interrupt() override;

 private:
  struct Buffer {
    void* memory;
    std::size_t bytes;
  };

  // ioctl that is not interrupted; throws Error in words but where errno is `expected`, then it is false.
  bool control(unsigned long request, void* argument, const char* what, int expected = 0) const;
  [[noreturn]] void fail(const std::string& why) const;
  void check_that_it_is_a_camera() const;
  void set_format();
  std::string sizes_of(std::uint32_t pixel_format) const;
  void set_rate();
  void map_buffers();
  void start();
  // The oldest filled buffer as a picture; nullopt: there is none (`was_filled` false), or it was damaged.
  std::optional<hrt::CameraPicture> take(bool& was_filled);

  const CameraOnRobot camera_;
  int device_ = -1, interrupt_ = -1;
  hrt::CameraPicture::Encoding encoding_ = hrt::CameraPicture::Encoding::jpeg;
  std::size_t row_bytes_ = 0;
  std::chrono::duration<double> period_{};
  std::vector<Buffer> buffers_;
  bool streams_ = false;
  std::uint64_t first_number_ = 1;  // of the stream's picture 0, so that numbers grow over pauses
  std::uint64_t newest_number_ = 0;
};

}  // namespace kenaf::real
