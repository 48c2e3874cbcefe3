// Robots that move alike and differ only in what they report: one simulation serves them all (roll_outs()).
//
// Thread safety: a pure function.
#pragma once

#include "physics/robot_description.hpp"
#include "physics/world_description.hpp"
#include "rollout/manoeuvre.hpp"

namespace kenaf::rollout {

// The robot without what does not change its motion in this manoeuvre and world. That is INS, IMU and the effects on
// them and on motion capture; encoders, tachometers and drives' sensors too, unless the manoeuvre takes the robot's
// motion from what they reported; the effects on obstacles where there are none; and of how late the pose is reported,
// all but what moves the start (first_report.hpp). Robots for which this is equal move alike, bit for bit.
physics::RobotDescription as_it_moves(physics::RobotDescription robot, const physics::WorldDescription& world,
                                      const Manoeuvre& manoeuvre);

}  // namespace kenaf::rollout
