// The moving parts of a robot, two tracks and four flippers, in the order of all arrays. A flipper's angle is 0
// straight out along the body and positive with its tip up, for all four. Radians.
//
// Thread safety: constants and pure functions.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace kenaf::robot {

enum Track : std::size_t { kLeft, kRight, kTrackCount };
enum Flipper : std::size_t { kFrontLeft, kFrontRight, kRearLeft, kRearRight, kFlipperCount };

constexpr bool is_front(Flipper flipper) {
  return flipper == kFrontLeft || flipper == kFrontRight;
}
constexpr Track side_of(Flipper flipper) {
  return flipper == kFrontLeft || flipper == kRearLeft ? kLeft : kRight;
}

// As in the names of a run's columns: flipper_fl_rad, ...
inline constexpr std::array<std::string_view, kTrackCount> kTrackNames{"left", "right"};
inline constexpr std::array<std::string_view, kFlipperCount> kFlipperNames{"fl", "fr", "rl", "rr"};

}  // namespace kenaf::robot
