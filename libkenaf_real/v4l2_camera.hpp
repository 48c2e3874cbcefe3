// A video device of Linux (V4L2) that streams into memory it shares with the program: webcams, capture cards, vivid.
// Source: the kernel's Documentation/userspace-api/media/v4l.
//
// Delivers Motion JPEG, passed on unchanged, or YUYV; Motion JPEG if available, because USB has the bandwidth for it at
// full rate. The resolution is exactly the description's, the rate the nearest that the device supports.
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

// Extracts a picture's bytes from a filled buffer. `row_bytes`: row stride in the buffer, YUYV only. nullopt if it is
// incomplete, as happens when webcams start and when USB loses packets.
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

  // ioctl that restarts after signals; returns false if errno is `expected`, and throws Error on any other failure.
  bool control(unsigned long request, void* argument, const char* what, int expected = 0) const;
  [[noreturn]] void fail(const std::string& why) const;
  void check_that_it_is_a_camera() const;
  void set_format();
  std::string sizes_of(std::uint32_t pixel_format) const;
  void set_rate();
  void map_buffers();
  void start();
  // Returns the oldest filled buffer as a picture; nullopt if there was none (`was_filled` false) or it was damaged.
  std::optional<hrt::CameraPicture> take(bool& was_filled);

  const CameraOnRobot camera_;
  int device_ = -1, interrupt_ = -1;
  hrt::CameraPicture::Encoding encoding_ = hrt::CameraPicture::Encoding::jpeg;
  std::size_t row_bytes_ = 0;
  std::chrono::duration<double> period_{};
  std::vector<Buffer> buffers_;
  bool streams_ = false;
  std::uint64_t first_number_ = 1;  // number of the stream's picture 0, so that numbers grow over pauses
  std::uint64_t newest_number_ = 0;
};

}  // namespace kenaf::real
