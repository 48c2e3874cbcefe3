// Trapezoid profiles: where a drive wants its motor to be, one step after another. CiA 402-2, profile velocity and
// profile position mode. Any units; those of one call go together.
#pragma once

namespace kenaf::candrives {

// What the drive demands of its motor.
struct Demand {
  double position = 0, velocity = 0;
};

struct Ramps {
  double acceleration, deceleration;  // greater than 0; the first while the speed grows, the second while it falls
};

// One step on the ramps towards `velocity`, and on with it. Within a step the speed changes evenly, so a ramp from v to
// 0 takes v / deceleration and v^2 / (2 deceleration), but for the step in which it ends.
void ramp_to_velocity(Demand& demand, double velocity, const Ramps& ramps, double step_s);

// One step nearer to `position`, at most at `max_speed`, so that the deceleration brings it to rest there. True: it is
// there. A position that is too near to stop at is passed and come back to.
bool move_to_position(Demand& demand, double position, double max_speed, const Ramps& ramps, double step_s);

}  // namespace kenaf::candrives
