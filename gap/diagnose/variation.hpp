// How a simulation differs from the nominal one of a run.
//
// Thread safety: a value.
#pragma once

#include "physics/robot_description.hpp"
#include "physics/world.hpp"

namespace kenaf::gap::diagnose {

// A robot and a simulator, how far from the observed start the robot is put down, and how much earlier than the log
// says its samples were taken, in parts of the time since the one before (of the angles alone in the passage from body
// to sensor).
struct Variation {
  physics::RobotDescription robot;
  physics::PhysicsSettings physics;
  double start_x_m = 0, start_y_m = 0, start_yaw_rad = 0;
  double samples_late = 0;

  bool operator==(const Variation&) const = default;
};

}  // namespace kenaf::gap::diagnose
