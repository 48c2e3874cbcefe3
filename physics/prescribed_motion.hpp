// Prescribed motion of belts and flippers, as measured on a robot: replaces commands and drives. SI units.
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
