// A track's drive and the battery: what is between a commanded speed and the belt.
#pragma once

#include "physics/robot_description.hpp"
#include "physics/surface.hpp"

namespace kenaf::physics {

// The closed speed loop is a first-order lag from the command to a reference, and a motor that follows the reference
// as far as its force reaches. In the motor's own direction of turning the force falls linearly from standstill to
// none at the maximum speed (the torque-speed line of a DC motor); against it, all of it can brake.
struct TrackDrive {
  double reference_mps = 0;
  double travel_m = 0;

  void before_step(Belt& belt, const TrackDriveDescription& drive, double commanded_mps, double time_step_s);
  void after_step(const Belt& belt, double time_step_s) { travel_m += belt.speed_mps * time_step_s; }
};

// Motor current, never negative: what force it gives and what its own friction takes while it turns.
double track_current_a(const TrackDriveDescription& drive, const Belt& belt, double time_step_s);

}  // namespace kenaf::physics
