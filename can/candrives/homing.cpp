#include "can/candrives/homing.hpp"

#include <cmath>

namespace kenaf::candrives {

bool is_homing_method(std::int64_t method) {
  return method == 17 || method == 18 || method == 35 || method == 37;
}

void Homing::start(const HomingSetup& setup, double position) {
  setup_ = setup;
  home_ = position;
  phase_ = setup.method == 17 || setup.method == 18 ? Phase::search : Phase::stopping;
}

void Homing::step(Demand& demand, double position, bool negative_switch, bool positive_switch, double step_s) {
  // Method 17 uses the negative switch, 18 the positive one; both search towards it.
  const Ramps ramps{setup_.acceleration, setup_.acceleration};
  const double towards_switch = setup_.method == 17 ? -1 : 1;
  const bool at_switch = setup_.method == 17 ? negative_switch : positive_switch;
  const auto run = [&](double velocity) { ramp_to_velocity(demand, velocity, ramps, step_s); };

  // On the switch, turn back at the slow speed; home is where the switch opens.
  if (phase_ == Phase::search && at_switch) phase_ = Phase::retreat;
  if (phase_ == Phase::retreat && !at_switch) {
    home_ = position;
    phase_ = Phase::stopping;
  }
  // A motor that lags this far has hit something other than the switch.
  if (is_moving() && std::abs(demand.position - position) > setup_.max_lag) phase_ = Phase::failed;

  // Each phase is a speed that the demand ramps to.
  switch (phase_) {
    case Phase::search:
      return run(towards_switch * setup_.search_speed);
    case Phase::retreat:
      return run(-towards_switch * setup_.slow_speed);
    case Phase::stopping:
      run(0);
      if (demand.velocity == 0) phase_ = Phase::attained;
      return;
    case Phase::idle:
    case Phase::attained:
    case Phase::failed:
      return run(0);
  }
}

}  // namespace kenaf::candrives
