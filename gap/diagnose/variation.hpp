// Differences of a simulation from the nominal one of a run.
//
// Thread safety: a value.
#pragma once

#include "physics/robot_description.hpp"
#include "physics/world.hpp"

namespace kenaf::gap::diagnose {

// Robot, simulator settings, offset from the observed start pose, and how much earlier than logged the samples were
// taken, in sample intervals (for angles only in the passage from body to sensor).
struct Variation {
  physics::RobotDescription robot;
  physics::PhysicsSettings physics;
  double start_x_m = 0, start_y_m = 0, start_yaw_rad = 0;
  double samples_late = 0;

  bool operator==(const Variation&) const = default;
};

}  // namespace kenaf::gap::diagnose
