// A snapshot as hrt.h presents it: in millimetres and degrees, and as text. The only place that converts from SI.
#pragma once

#include <string>

#include "hrt/robot.hpp"
#include "kenaf/hrt.h"

namespace kenaf::hrt {

inline constexpr double kMillimetres = 1e3;
inline constexpr double kDegrees = 57.295779513082320877;  // 180 / pi

hrt_state state_from(const Snapshot& snapshot);

// A few lines of text, each ended by '
// '.
std::string status_text(const hrt_state& state, const std::string& library);

}  // namespace kenaf::hrt
