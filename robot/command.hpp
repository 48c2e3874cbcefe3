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
  JointMode mode = JointMode::angle;
  double value = 0;  // rad, rad/s, N m; unused for brake and keep
  bool operator==(const JointCommand&) const = default;
};

// What the robot shall do from its next cycle on, on a bus, in a datagram and in the simulator alike. Absolute: it
// holds until the next one.
struct Command {
  std::array<double, kTrackCount> track_speed_mps{};  // surface speed of each track relative to the body, + = forward
  std::array<JointCommand, kFlipperCount> flipper{};
  bool operator==(const Command&) const = default;
};

// A command of a program that has not yet commanded anything: tracks at rest, flippers as they are.
inline Command idle_command() {
  Command command;
  command.flipper.fill({JointMode::keep, 0});
  return command;
}

}  // namespace kenaf::robot
