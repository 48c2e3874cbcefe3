// Robots that differ only in what they report of a drive: one simulation serves them all (roll_outs()).
//
// Thread safety: a pure function.
#pragma once

#include "physics/robot_description.hpp"
#include "rollout/manoeuvre.hpp"

namespace kenaf::rollout {

// The robot without what changes only its reports: INS, IMU and the effects on them and on motion capture; encoders,
// tachometers and drives' sensors too, unless the manoeuvre takes the robot's motion from what they reported. Robots
// for which this is equal move alike, bit for bit.
physics::RobotDescription without_reports(physics::RobotDescription robot, const Manoeuvre& manoeuvre);

}  // namespace kenaf::rollout
