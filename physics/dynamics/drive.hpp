// A track's drive, from the commanded speed to the belt.
#pragma once

#include "physics/dynamics/surface.hpp"
#include "physics/robot_description.hpp"

namespace kenaf::physics {

// The closed speed loop is a first-order lag from the command to a reference, and a motor that follows the reference
// as far as its force reaches. When driving, the available force falls linearly from standstill to zero at the maximum
// speed (the torque-speed line of a DC motor); when braking, all of it is available. Both ends of the line scale with
// the battery's voltage. A loop with droop has no integrator: its motor's force is (reference - speed) / droop, within
// the same limits. On the line the H-bridge is fully on: the motor takes the current that voltage and winding allow.
// The effect drive_lag is a second lag before the loop's: with lags a and b a step is followed as
// 1 - (a exp(-t/a) - b exp(-t/b)) / (a - b). drive_torque_limit scales the line at standstill; speed without load and
// amperes per newton stay. Dry friction is a bound in the solver, so it holds a belt still up to its force.
class TrackDrive {
 public:
  TrackDrive(robot::Track side, const TrackDriveDescription& drive, const Effects& effects);

  // Sets the state that a long time at this commanded speed would leave.
  void turn_at(double speed_mps) { lagged_mps_ = reference_mps_ = speed_mps; }
  // Instead of before_step(): in the next step the belt has this speed, regardless of motor and running gear.
  void prescribe(Belt& belt, double speed_mps);
  void before_step(Belt& belt, double commanded_mps, double voltage_share, double time_step_s);
  void after_step(const Belt& belt, double time_step_s) { travel_m_ += belt.speed_mps * time_step_s; }

  double travel_m() const { return travel_m_; }
  // Motor current, never negative: for its force, and for its own friction while it turns.
  double current_a(const Belt& belt, double time_step_s) const;
  // The part of it that the battery supplies.
  double battery_current_a(const Belt& belt, double voltage_share, double time_step_s) const;

 private:
  TrackDriveDescription drive_;  // with the effects on it
  double lag_s_, droop_mpspn_, dry_friction_n_, viscous_nspm_, rolling_resistance_;
  double lagged_mps_ = 0;     // the command after the second lag
  double reference_mps_ = 0;  // the motor's set speed
  double travel_m_ = 0;
};

}  // namespace kenaf::physics
