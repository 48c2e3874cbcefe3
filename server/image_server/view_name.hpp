// Determines which camera a reader means. Pure functions.
//
//   ROBOT/CAMERA   that camera of that robot; of several robots of one name, the one placed last
//   #N/CAMERA      that camera of the robot N, by RobotId, whatever its name
//   CAMERA         that camera of the robot placed last that has one
//   (empty)        the first camera of the robot placed last that has one
// Names are compared without case, as in USARSim. A view may show different cameras as robots come and go.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "camera/snapshot.hpp"
#include "server/image_server/frame.hpp"

namespace kenaf::image_server {

// Returns "#N", which find_view() resolves to that robot only.
std::string view_of(physics::RobotId robot);

// `robots`: in the order of their placement. Empty: there is no such camera now.
std::optional<CameraId> find_view(const std::vector<camera::RobotSnapshot>& robots, std::string_view view);

// Explains why find_view() finds nothing, and lists what there is; at most some 1000 bytes.
std::string no_such_view(const std::vector<camera::RobotSnapshot>& robots, std::string_view view);

}  // namespace kenaf::image_server
