// A description's sensors and cameras as frames of a URDF. Thread safety: a pure function.
#pragma once

#include <set>
#include <string>

#include "physics/robot_description.hpp"

namespace kenaf::describe {

// Links, fixed joints and what Gazebo reads; see to_urdf.hpp. `names`: of the links that there are, to which these are
// added; a sensor of such a name has one with "_sensor" behind it.
std::string sensor_frames(const physics::RobotDescription& robot, std::set<std::string>& names);

}  // namespace kenaf::describe
