// A robot that differs from its description in named numbers. Thread safety: a pure function.
#pragma once

#include <map>
#include <string>

#include "physics/robot_description.hpp"

namespace kenaf::python {

using Values = std::map<std::string, double>;

// A name is that of a number of the description, as kenaf-gap effects --robot lists them ("track.friction_across"), or
// of a parameter of a catalogue effect: "drive_lag:lag_s", or just "drive_lag" if the effect has one parameter. Throws
// std::invalid_argument if a name is unknown, two names change one number, a value is out of range, or the values
// together make an impossible robot.
physics::RobotDescription robot_with(const physics::RobotDescription& robot, const Values& values);

}  // namespace kenaf::python
