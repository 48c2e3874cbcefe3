// A track's drive: what is between a commanded speed and the belt.
#pragma once

#include "physics/dynamics/surface.hpp"
#include "physics/robot_description.hpp"

namespace kenaf::physics {

// The closed speed loop is a first-order lag from the command to a reference, and a motor that follows the reference
// as far as its force reaches. In the motor's own direction of turning the force falls linearly from standstill to
// none at the maximum speed (the torque-speed line of a DC motor); against it, all of it can brake. Both ends of the
// line shrink with the battery's voltage. A loop with droop has no integrator: its motor gives force in proportion to
// what is lacking to the reference, (reference - speed) / droop, within the same bounds. On that line the motor has the
// voltage all to itself, so what current voltage and winding allow is what force the line allows.
class TrackDrive {
 public:
  TrackDrive(robot::Track side, const TrackDriveDescription& drive, const Effects& effects);

  // As after turning at this speed for long, commanded so: it goes on from here.
  void turn_at(double speed_mps) { lagged_mps_ = reference_mps_ = speed_mps; }
  // Instead of before_step(): in the next step the belt has this speed, whatever motor and running gear are.
  void prescribe(Belt& belt, double speed_mps);
  void before_step(Belt& belt, double commanded_mps, double voltage_share, double time_step_s);
  void after_step(const Belt& belt, double time_step_s) { travel_m_ += belt.speed_mps * time_step_s; }

  double travel_m() const { return travel_m_; }
  // Motor current, never negative: what force it gives and what its own friction takes while it turns.
  double current_a(const Belt& belt, double time_step_s) const;
  // What of it the battery gives.
  double battery_current_a(const Belt& belt, double voltage_share, double time_step_s) const;

 private:
  TrackDriveDescription drive_;  // with the effects on it
  double lag_s_, droop_mpspn_, dry_friction_n_, viscous_nspm_;
  double lagged_mps_ = 0;     // the command behind the second lag
  double reference_mps_ = 0;  // what the motor follows
  double travel_m_ = 0;
};

}  // namespace kenaf::physics
