// On the wire an encoder has a name for each side of the robot; here it is one sensor.
#pragma once

#include <array>
#include <string_view>

#include "robot/parts.hpp"

namespace kenaf::world_server {

inline constexpr std::array<std::string_view, robot::kTrackCount> kEncoderNames = {"ECLeft", "ECRight"};

}  // namespace kenaf::world_server
