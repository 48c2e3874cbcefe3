// Commands as a program gives them: two belts and some of the flippers.
#pragma once

#include <array>
#include <cstdint>

#include "robot/command.hpp"

namespace kenaf::support {

// Bit i of `mask`: flipper i is to reach flipper_rad[i]; the others are kept, and their numbers are in the command as
// they are in a datagram.
inline robot::Command command_of(const std::array<double, robot::kTrackCount>& track_mps, unsigned mask = 0,
                                 const std::array<double, robot::kFlipperCount>& flipper_rad = {}) {
  using robot::JointMode;
  robot::Command command{track_mps, {}};
  for (std::size_t i = 0; i < robot::kFlipperCount; ++i)
    command.flipper[i] = {(mask >> i & 1u) != 0 ? JointMode::angle : JointMode::keep, flipper_rad[i]};
  return command;
}

}  // namespace kenaf::support
