// A picture that a robot's camera took, as it is handed to whoever reads it: never changed once it is published.
//
// Thread safety: pure functions; a published Frame is for any thread.
#pragma once

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

// A camera of a robot in the world: never used twice.
struct CameraId {
  physics::RobotId robot;
  std::size_t camera;  // index in the robot's description
  auto operator<=>(const CameraId&) const = default;
};

struct Frame {
  CameraId id;
  std::string robot, camera;  // their names
  std::uint64_t number = 0;   // of this camera, from 1; a gap: so many were not drawn in time
  double robot_time_s = 0;    // of the moment that it shows
  SteadyTime exposed;         // the same moment by the wall clock
  camera::Picture picture;
  std::vector<std::uint8_t> jpeg;  // at the camera's own quality
};

// How old what the frame shows is.
double age_s(const Frame& frame, SteadyTime now = std::chrono::steady_clock::now());

// What every JPEG that leaves the server begins with: SOI, and a COM segment that says which frame this is and how old,
//   kenaf-frame/1 number=%llu robot_time_s=%.6f age_ms=%.3f robot=%s camera=%s
// Names of more than 128 bytes are cut. Behind it follows after_start(jpeg): all but its SOI.
std::string stamped_start(const Frame& frame, double age_s);
std::span<const std::uint8_t> after_start(std::span<const std::uint8_t> jpeg);

}  // namespace kenaf::image_server
