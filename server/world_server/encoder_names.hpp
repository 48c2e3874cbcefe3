// On the wire an encoder has a name for each side of the robot; here it is one sensor.
#pragma once

#include <array>
#include <string_view>

namespace kenaf::world_server {

// In the order of robot::Track.
inline constexpr std::array<std::string_view, 2> kEncoderNames = {"ECLeft", "ECRight"};

}  // namespace kenaf::world_server
