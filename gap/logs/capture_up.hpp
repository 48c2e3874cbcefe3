// Motion captures whose z axis does not point up, as Motive's, whose y axis does.
//
// Thread safety: pure functions.
#pragma once

#include <optional>
#include <string>

#include "gap/logs/motion_capture.hpp"

namespace kenaf::gap::logs {

enum class Up { z, y, minus_y, minus_z };  // the capture's axis that points up

std::string name_of(Up up);  // "y", "-y"

// Turns the capture about its x axis so that z points up: y-up (x, y, z) becomes (x, -z, y), z-down (x, -y, -z). The
// body's axes are turned likewise if they are the capture's while the robot stands level, as where the body was defined
// in the capture's frame; they stay if its z axis points up already. Whichever keeps the robot more upright is taken.
// Throws RunFileError if the capture has no z or no quaternion or tilt.
MotionCapture with_z_up(MotionCapture capture, Up up, const std::string& name_for_errors);

struct UpSeen {
  Up up;
  std::string why;
};

// Returns the axis that points up if it certainly is not z: the body's z axis lies along it most of the time; or the
// robot's gyro, or without one its tracks, turns as the capture does about y while y stays and x and z change; or z
// changes by more than 0.5 m and 1.5 times as far as x and y, steeper than a robot climbs. Limits chosen.
std::optional<UpSeen> up_seen(const runs::Run& run, const MotionCapture& capture);

}  // namespace kenaf::gap::logs
