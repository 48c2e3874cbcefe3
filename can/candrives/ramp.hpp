// Trapezoidal profiles: the desired motor position, step by step. CiA 402-2, profile velocity and profile position
// mode. Any units, consistent within a call.
#pragma once

namespace kenaf::candrives {

// The motor demand of the drive.
struct Demand {
  double position = 0, velocity = 0;
};

struct Ramps {
  double acceleration, deceleration;  // greater than 0; for growing and falling speed, respectively
};

// One step of the ramp towards `velocity`, then at constant speed. Within a step the speed changes linearly, so a ramp
// from v to 0 takes v / deceleration and v^2 / (2 deceleration), except for the step in which it ends.
void ramp_to_velocity(Demand& demand, double velocity, const Ramps& ramps, double step_s);

// One step towards `position`, at most at `max_speed`, so that the deceleration stops exactly there. Returns true on
// arrival. A position too near to stop at is overrun and returned to.
bool move_to_position(Demand& demand, double position, double max_speed, const Ramps& ramps, double step_s);

}  // namespace kenaf::candrives
