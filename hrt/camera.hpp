// Interface between the shared behaviour and a camera: libkenaf_sim reads the world server's image port, libkenaf_real
// a video device.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kenaf/hrt.h"

namespace kenaf::hrt {

// A picture as the camera delivered it.
struct CameraPicture {
  enum class Encoding : std::uint8_t {
    jpeg,  // a complete JPEG file, whose header has width and height
    rgb,   // red, green, blue; rows from the top, no padding
    yuyv   // Y0 U Y1 V for each two pixels, ITU-R BT.601, 16 to 235; rows from the top, no padding; width is even
  };
  Encoding encoding = Encoding::jpeg;
  int width = 0, height = 0;             // of rgb and yuyv; they determine the number of bytes
  std::uint64_t number = 0;              // grows; an equal number means the same picture again
  std::optional<double> robot_time_s{};  // of the exposure; nullopt: unknown to the camera
  std::optional<std::chrono::steady_clock::time_point> exposed_at{};  // not later than the true time; nullopt: unknown
  int jpeg_quality = 80;                                              // used when a file is made of rgb or yuyv
  std::string camera{};                                               // its name; "": unknown
  std::vector<std::uint8_t> bytes{};
};

// Thread safety: open, next and pause belong to one thread at a time; interrupt may be called from any.
class Camera {
 public:
  virtual ~Camera() = default;

  // Throws Error (HRT_E_LINK, HRT_E_DEVICE or HRT_E_CONFIG) whose text says what to start or to connect. Returns early
  // if interrupted.
  virtual void open() = 0;

  // Waits for the next picture, which may be the same again; nullopt after interrupt(). Throws Error once no further
  // picture can be expected.
  virtual std::optional<CameraPicture> next() = 0;

  // No pictures are wanted for now. The next picture after a pause is no older than if the camera had been opened anew.
  virtual void pause() = 0;

  // Makes open and next return, now and at every later call.
  virtual void interrupt() = 0;
};

// Each of the two libraries defines these.
// Returns the identity of the camera `name`: two names of one camera give the same. "" is the robot's first camera.
// Throws Error if the camera is known not to exist without opening it.
std::string resolve_camera(const hrt_config& config, const std::string& name);
// `camera`: as resolve_camera returned it. Cheap: opens nothing yet.
std::unique_ptr<Camera> make_camera(const hrt_config& config, const std::string& camera);

}  // namespace kenaf::hrt
