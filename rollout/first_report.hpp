// Where a replayed robot starts if its pose was reported late or early: the start that is recorded is where it was
// then, not where it was when the run began.
//
// Thread safety: pure functions.
#pragma once

#include "rollout/roll_out.hpp"
#include "rollout/tracking.hpp"

namespace kenaf::rollout {

// Whether that matters to how the robot moves: obstacles would otherwise come too early or too late. Without any, the
// path is only reported from another start (tracking.hpp).
bool starts_elsewhere(const physics::Effects& effects, const physics::WorldDescription& world,
                      const Manoeuvre& manoeuvre);

// Returns where the robot is when the pose of the first row is taken, in the plane, as seen from where it starts. An
// early one costs a simulation of the time until then. A robot that moves at the start was on its way at that speed.
physics::Pose at_first_report(const physics::RobotDescription& robot, const physics::WorldDescription& world,
                              const Manoeuvre& manoeuvre, const RollOutOptions& options);

}  // namespace kenaf::rollout
