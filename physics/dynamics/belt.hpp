// A track's belt in the solver of a step: one degree of freedom in addition to the bodies. The motor drives it, the
// friction on all the surfaces it runs over and in its running gear brakes it. Motor and viscous friction are linear
// and eliminated: what is left to iterate over is dry friction and the contacts' push, which moves the belt by
//   speed_mps = base_mps + mobility_per_kg * push_ns
// Thread safety: values; each belt by one thread.
#pragma once

#include "physics/dynamics/limited_drive.hpp"

namespace kenaf::physics {

struct Belt {
  // Set before a step.
  double moving_mass_kg = 1;
  LimitedDrive motor;
  double dry_friction_ns = 0;     // of the running gear, within a step
  double viscous_nspm = 0;        // of the running gear
  double rolling_resistance = 0;  // friction force for a unit of normal force on the belt
  double slip_spm = 0;            // the surface moves with speed (1 - slip |speed|)
  // State: of the surface relative to the body, + drives the robot forward.
  double speed_mps = 0;
  // Results of a step.
  double motor_impulse_ns = 0;
  double friction_impulse_ns = 0;  // dry and rolling, of the running gear
  double load_ns = 0;              // normal impulse on it
  // While a step is solved.
  double start_mps = 0;  // before the step
  double viscous_ns = 0;
  double base_mps = 0, mobility_per_kg = 0;  // 0: the motor holds the speed
  double push_ns = 0;                        // by contacts and dry friction
  double warm_start_share = 1;               // of the last friction impulse of a contact that stuck

  double solved_mps() const { return base_mps + mobility_per_kg * push_ns; }
};

// Takes over the last step's dry friction as this one's to start from.
void start_step(Belt& belt, double time_step_s);
// Without contacts, with the motor at the limit that it says.
void begin_anew(Belt& belt);
// One iteration over dry and rolling friction. Returns the squared change of speed.
double solve_friction(Belt& belt);
// Whether the motor is at another limit than was assumed; begin_anew() has to follow.
bool settle_motor(Belt& belt);
void finish_step(Belt& belt);

}  // namespace kenaf::physics
