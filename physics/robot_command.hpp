// What a robot in the world can be told to do. SI units, frames of REP 103. Thread safety: values.
#pragma once

#include <array>
#include <optional>

#include "protocol/relay_datagram.hpp"

namespace kenaf::physics {

using relay::Flipper;
using relay::kFlipperCount;
using relay::kFrontLeft;
using relay::kFrontRight;
using relay::kLeft;
using relay::kRearLeft;
using relay::kRearRight;
using relay::kRight;
using relay::kTrackCount;
using relay::Track;

// A flipper servo's mode, after USARSim's joint orders 0 to 3.
enum class JointMode { angle, speed, torque, brake };

struct JointCommand {
  JointMode mode = JointMode::angle;
  double value = 0;  // rad (0 = straight out along the body, positive tip up), rad/s, N m; unused for brake
};

// Complete and absolute: it holds until the next one.
struct RobotCommand {
  std::array<double, kTrackCount> track_speed_mps{};  // surface speed of each track relative to the body, + = forward
  std::array<JointCommand, kFlipperCount> flipper{};
};

// What belts and flippers do whatever they are told: as measured on a robot, so that its drives play no part.
struct PrescribedMotion {
  std::array<std::optional<double>, kTrackCount> track_mps{};      // surface speed; empty: the drive follows the command
  std::array<std::optional<double>, kFlipperCount> flipper_rad{};  // likewise
  bool operator==(const PrescribedMotion&) const = default;
};

}  // namespace kenaf::physics
