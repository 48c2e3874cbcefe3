// The battery: a voltage source behind a resistance. The drives' current lowers the voltage, and the voltage limits the
// drives in the next step.
#pragma once

#include "physics/robot_description.hpp"

namespace kenaf::physics {

// Returns the current that a motor takes from the battery, in amperes. The motor's H-bridge chops: the battery
// supplies the motor's current only in its duty cycle, the share of the voltage that the motor needs: `force_share`
// (over the force at standstill) plus `speed_share` (over the speed without load, negative against the force). A motor
// that is turned against its force generates a voltage: if that suffices, the battery supplies nothing, and gets
// nothing back, since the energy is burnt in the bridge.
double battery_current_a(double motor_current_a, double force_share, double speed_share, double voltage_share);

class Battery {
 public:
  // `stalled_a`: total current of all drives at standstill with full force at the open-circuit voltage.
  Battery(const BatteryDescription& battery, double added_resistance_ohm, double stalled_a);

  void after_step(double current_a, double time_step_s);

  double voltage_v() const { return voltage_v_; }
  // Voltage over the open-circuit voltage, 0 to 1: scales a motor's force at standstill and its speed without load.
  double voltage_share() const { return voltage_v_ / open_circuit_v_; }
  double left_s() const { return left_s_; }  // as USARSim counts it

 private:
  double open_circuit_v_, resistance_ohm_, response_;
  double voltage_v_, left_s_;
};

}  // namespace kenaf::physics
