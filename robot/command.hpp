// Commands to a robot. SI units; frames of REP 103: x forward, y left, z up.
//
// Thread safety: values.
#pragma once

#include <array>

#include "robot/parts.hpp"

namespace kenaf::robot {

// A flipper servo's mode, after USARSim's joint orders 0 to 3.
enum class JointMode { angle, speed, torque, brake };

struct JointCommand {
  JointMode mode = JointMode::angle;
  double value = 0;  // rad, rad/s, N m; unused for brake
};

// Complete and absolute: it holds until the next one.
struct Command {
  std::array<double, kTrackCount> track_speed_mps{};  // surface speed of each track relative to the body, + = forward
  std::array<JointCommand, kFlipperCount> flipper{};
};

}  // namespace kenaf::robot
