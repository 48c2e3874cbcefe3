// Ranges that parse_robot() accepts, as in physics/robot_description.cpp. For robot_numbers.cpp and wheel_numbers.cpp.
#pragma once

#include "gap/candidates/robot_numbers.hpp"

namespace kenaf::gap::candidates {

inline constexpr NumberRange kAnyNumber{};
inline constexpr NumberRange kAboveZero{.min = 0, .open_min = true};
inline constexpr NumberRange kZeroOrMore{.min = 0};
inline constexpr NumberRange kFrictionRange{.min = 0, .max = 10};

}  // namespace kenaf::gap::candidates
