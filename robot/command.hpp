// Commands to a robot. SI units; frames of REP 103: x forward, y left, z up.
//
// Thread safety: values.
#pragma once

#include <array>

#include "robot/parts.hpp"

namespace kenaf::robot {

// A flipper servo's mode: USARSim's joint orders 0 to 3, and `keep`, which leaves the servo's last command in force.
enum class JointMode { angle, speed, torque, brake, keep };

struct JointCommand {
  JointMode mode = JointMode::keep;
  double value = 0;  // rad, rad/s, N m; unused for brake and keep
  bool operator==(const JointCommand&) const = default;
};

// The command for the robot from its next cycle on, on a bus, in a datagram and in the simulator alike. Absolute: it
// holds until the next one. A Command that nobody filled in stops the tracks and leaves the flippers as they are.
struct Command {
  std::array<double, kTrackCount> track_speed_mps{};  // surface speed of each track relative to the body, + = forward
  std::array<JointCommand, kFlipperCount> flipper{};
  bool operator==(const Command&) const = default;
};

}  // namespace kenaf::robot
