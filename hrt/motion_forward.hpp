// Drives straight by the track encoders while holding a heading. A pure state machine: one step per cycle.
#pragma once

#include "hrt/motion.hpp"

namespace kenaf::hrt {

class GoForward {
 public:
  // `heading_rad`: the heading to hold, in the estimate's unwrapped angle.
  GoForward(const MotionLimits& limits, double distance_m, double heading_rad, const Estimate& start);
  MotionStep step(const Estimate& now);

 private:
  MotionStep fail(int code, const Estimate& now, const std::string& why) const;

  MotionLimits limits_;
  Approach approach_;
  double distance_m_, heading_rad_, start_travel_m_, start_t_s_, time_limit_s_;
  double speed_mps_ = 0;  // last command
  bool holding_ = false;  // within the goal's band, tracks at 0
  ProgressWatch watch_;
};

}  // namespace kenaf::hrt
