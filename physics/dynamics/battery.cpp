#include "physics/dynamics/battery.hpp"

#include <algorithm>

namespace kenaf::physics {

double battery_current_a(double motor_current_a, double force_share, double speed_share, double voltage_share) {
  if (!(voltage_share > 0)) return 0;
  return motor_current_a * std::clamp((force_share + speed_share) / voltage_share, 0.0, 1.0);
}

// The voltage under a current is known a step late, and lower voltage means less current: followed at once, the two
// would oscillate from step to step if resistance x stalled current exceeds the open-circuit voltage V. Drives at their
// limit draw I_stalled v / V; Newton's step for v = V - R I(v) is the share 1 / (1 + R I_stalled / V).
Battery::Battery(const BatteryDescription& battery, double added_resistance_ohm, double stalled_a)
    : open_circuit_v_(battery.open_circuit_v),
      resistance_ohm_(battery.internal_resistance_ohm + added_resistance_ohm),
      response_(1 / (1 + resistance_ohm_ * stalled_a / battery.open_circuit_v)),
      voltage_v_(battery.open_circuit_v),
      left_s_(battery.capacity_s) {}

void Battery::after_step(double current_a, double time_step_s) {
  const double loaded_v = std::max(0.0, open_circuit_v_ - resistance_ohm_ * current_a);
  voltage_v_ += response_ * (loaded_v - voltage_v_);
  left_s_ = std::max(0.0, left_s_ - time_step_s);
}

}  // namespace kenaf::physics
