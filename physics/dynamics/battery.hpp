// The battery: a voltage source behind a resistance. What the drives draw lowers the voltage, and the voltage limits
// what they can do in the next step.
#pragma once

#include "physics/robot_description.hpp"

namespace kenaf::physics {

// What a motor takes from the battery, in amperes. Its bridge chops: the battery gives the motor's current only for the
// share of time in which the motor needs the voltage, `force_share` of it for the force (of the one at standstill) and
// `speed_share` for turning (of the speed without load, negative against the force). A motor that is turned against its
// force makes a voltage of its own: where that is enough the battery gives nothing, and gets nothing either, since the
// energy is burnt in the bridge.
double battery_current_a(double motor_current_a, double force_share, double speed_share, double voltage_share);

class Battery {
 public:
  // `stalled_a`: what all drives together draw at standstill with full force at the open-circuit voltage.
  Battery(const BatteryDescription& battery, double added_resistance_ohm, double stalled_a);

  void after_step(double current_a, double time_step_s);

  double voltage_v() const { return voltage_v_; }
  // Over the open-circuit voltage, 0 to 1: by this a motor's force at standstill and its speed without load shrink.
  double voltage_share() const { return voltage_v_ / open_circuit_v_; }
  double left_s() const { return left_s_; }  // as USARSim counts it

 private:
  double open_circuit_v_, resistance_ohm_, response_;
  double voltage_v_, left_s_;
};

}  // namespace kenaf::physics
