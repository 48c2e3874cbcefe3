// Homing: how a drive whose encoder begins anywhere finds its position. CiA 402-2, homing mode, homing methods.
//
//   17  runs in the negative direction onto the negative limit switch, and slowly back: home is where the switch lets
//   go 18  the same with the positive limit switch 35, 37  home is here: nothing moves (35 is the number of older
//   drives)
#pragma once

#include <cstdint>

#include "can/candrives/ramp.hpp"

namespace kenaf::candrives {

bool is_homing_method(std::int64_t method);

// Positions in counts of the encoder since power on, speeds in counts per second.
struct HomingSetup {
  std::int64_t method;
  double search_speed, slow_speed, acceleration;
  double max_lag;  // further behind its demand the motor is held by something else than the switch
};

class Homing {
 public:
  enum class Phase { idle, search, retreat, stopping, attained, failed };
  Phase phase() const { return phase_; }
  bool is_moving() const { return phase_ == Phase::search || phase_ == Phase::retreat || phase_ == Phase::stopping; }
  double home() const { return home_; }  // once stopping or attained

  void start(const HomingSetup& setup, double position);
  void abandon() { phase_ = Phase::idle; }
  // One step of what was started: moves the demand.
  void step(Demand& demand, double position, bool negative_switch, bool positive_switch, double step_s);

 private:
  HomingSetup setup_{};
  Phase phase_ = Phase::idle;
  double home_ = 0;
};

}  // namespace kenaf::candrives
