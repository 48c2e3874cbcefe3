// Turns in place to a heading. A pure state machine: one step per cycle.
#pragma once

#include "hrt/motion.hpp"

namespace kenaf::hrt {

class TurnInPlace {
 public:
  // `goal_rad`: the heading to reach, in the estimate's unwrapped angle.
  TurnInPlace(const MotionLimits& limits, double goal_rad, const Estimate& start);
  MotionStep step(const Estimate& now);

 private:
  MotionStep fail(int code, const Estimate& now, const std::string& why) const;

  MotionLimits limits_;
  Approach approach_;
  double goal_rad_, start_heading_rad_, start_t_s_, time_limit_s_;
  double turn_radps_ = 0;  // last command
  bool holding_ = false;   // within the goal's band, tracks at 0
  ProgressWatch watch_;
};

}  // namespace kenaf::hrt
