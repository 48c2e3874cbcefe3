// Homing: how a drive with an arbitrary initial encoder position finds its position. CiA 402-2, homing methods:
//
//   17      runs in the negative direction onto the negative limit switch, then slowly back: home is where it opens
//   18      the same with the positive limit switch
//   35, 37  home is the present position: nothing moves (35 is the number of older drives)
#pragma once

#include <cstdint>

#include "can/candrives/ramp.hpp"

namespace kenaf::candrives {

bool is_homing_method(std::int64_t method);

// Positions in encoder counts since power on, speeds in counts per second.
struct HomingSetup {
  std::int64_t method;
  double search_speed, slow_speed, acceleration;
  double max_lag;  // with a larger lag behind the demand, something other than the switch holds the motor
};

class Homing {
 public:
  enum class Phase { idle, search, retreat, stopping, attained, failed };
  Phase phase() const { return phase_; }
  bool is_moving() const { return phase_ == Phase::search || phase_ == Phase::retreat || phase_ == Phase::stopping; }
  double home() const { return home_; }  // valid once stopping or attained

  void start(const HomingSetup& setup, double position);
  void abandon() { phase_ = Phase::idle; }
  // Advances the homing by one step: moves the demand.
  void step(Demand& demand, double position, bool negative_switch, bool positive_switch, double step_s);

 private:
  HomingSetup setup_{};
  Phase phase_ = Phase::idle;
  double home_ = 0;
};

}  // namespace kenaf::candrives
