// A picture taken by a robot's camera, as handed to readers: immutable once published.
//
// Thread safety: pure functions; a published Frame may be read by any thread.
#pragma once

#include <array>
#include <chrono>
#include <compare>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "camera/picture.hpp"
#include "physics/world.hpp"

namespace kenaf::image_server {

using SteadyTime = std::chrono::steady_clock::time_point;

// A camera of a robot in the world: never reused.
struct CameraId {
  physics::RobotId robot;
  std::size_t camera;  // index in the robot's description
  auto operator<=>(const CameraId&) const = default;
};

// How large a picture is drawn: as the camera's description has it, or with half of its width and height (rounded up),
// at a third of the cost, for a place that is no larger.
enum class PictureSize { full, half };
inline constexpr std::array kPictureSizes{PictureSize::full, PictureSize::half};
// One value for each of kPictureSizes, in their order.
template <typename Value>
using BySize = std::array<Value, kPictureSizes.size()>;
constexpr std::size_t index_of(PictureSize size) {
  return static_cast<std::size_t>(size);
}

// What a camera sees, and its JPEG at the camera's own quality.
struct CameraImage {
  camera::Picture picture;
  std::vector<std::uint8_t> jpeg;
};

struct Frame {
  CameraId id;
  std::string robot, camera;  // their names
  PictureSize size = PictureSize::full;
  std::uint64_t number = 0;                  // of this camera, from 1; a gap counts the pictures not drawn in time. The
                                             // same in both sizes for the same moment
  double robot_time_s = 0;                   // of the moment shown
  SteadyTime exposed;                        // the same moment on the wall clock
  std::shared_ptr<const CameraImage> image;  // never null; that of the frame before if nothing has moved since
};

// Returns the age of the moment shown.
double age_s(const Frame& frame, SteadyTime now = std::chrono::steady_clock::now());

// Returns the start of every JPEG that leaves the server: SOI, and a COM segment that identifies the frame and its age,
//   kenaf-frame/1 number=%llu robot_time_s=%.6f age_ms=%.3f robot=%s camera=%s
// Names longer than 128 bytes are truncated. after_start(jpeg) follows it: everything but its SOI.
std::string stamped_start(const Frame& frame, double age_s);
std::span<const std::uint8_t> after_start(std::span<const std::uint8_t> jpeg);

}  // namespace kenaf::image_server
