// What belts and flippers do whatever they are told: as measured on a robot, so that its drives play no part. SI units.
//
// Thread safety: a value.
#pragma once

#include <array>
#include <optional>

#include "robot/parts.hpp"

namespace kenaf::physics {

struct PrescribedMotion {
  std::array<std::optional<double>, robot::kTrackCount>
      track_mps{};  // surface speed; empty: the drive follows the command
  std::array<std::optional<double>, robot::kFlipperCount> flipper_rad{};  // likewise
  bool operator==(const PrescribedMotion&) const = default;
};

}  // namespace kenaf::physics
