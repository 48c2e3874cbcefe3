// The parts of a robot that move: two tracks and four flippers, and the order in which all arrays have them.
// A flipper's angle is 0 straight out along the body and positive with its tip up, for all four. Radians.
// Thread safety: constants.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace kenaf::robot {

enum Track : std::size_t { kLeft, kRight, kTrackCount };
enum Flipper : std::size_t { kFrontLeft, kFrontRight, kRearLeft, kRearRight, kFlipperCount };

// As in the names of a run's columns: flipper_fl_rad, ...
inline constexpr std::array<std::string_view, kTrackCount> kTrackNames{"left", "right"};
inline constexpr std::array<std::string_view, kFlipperCount> kFlipperNames{"fl", "fr", "rl", "rr"};

}  // namespace kenaf::robot
