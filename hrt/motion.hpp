// What the motion primitives share: their limits, their result, and the speed at which a goal is approached.
#pragma once

#include <array>
#include <cmath>
#include <string>

#include "hrt/estimate.hpp"
#include "kenaf/hrt.h"
#include "robot/parts.hpp"

namespace kenaf::hrt {

// hrt_config's motion part in SI units.
struct MotionLimits {
  double max_speed_mps, acceleration_mps2, distance_tolerance_m;
  double max_turn_radps, turn_acceleration_radps2, angle_tolerance_rad;
  double stuck_time_s, stuck_current_a;
  double track_gauge_m;
};
MotionLimits motion_limits_from(const hrt_config& config);

// What a motion commands in a cycle, and whether it goes on.
struct MotionStep {
  std::array<double, robot::kTrackCount> track_speed_mps{};
  bool finished = false;
  int code = HRT_OK;  // once finished
  std::string text;   // why it failed
};

// How fast a goal is approached: a trapezoid whose last part falls exponentially, so that neither the cycle's delay
// nor the drive's lag overshoots the goal. All in the unit of the distance: metres or radians.
struct Approach {
  double max_speed, acceleration;
  double gain;       // 1/s: the last part falls with this rate
  double min_speed;  // outside of the goal's band the motion never creeps slower

  // The speed for a signed `error` to the goal, `dt_s` after `before` was commanded. A motion that has not got on for
  // `without_progress_s` pushes harder: what is too slow to overcome friction or a drive's dead band grows until it
  // does.
  double speed(double error, double before, double dt_s, double without_progress_s = 0) const;
  // The time the profile takes over `distance` from standstill to standstill.
  double duration_s(double distance) const;
};

// Watches whether a motion gets on. One for each motion.
class ProgressWatch {
 public:
  ProgressWatch(const MotionLimits& limits, double step, const Estimate& start)
      : step_(step),
        stuck_time_s_(limits.stuck_time_s),
        stuck_current_a_(limits.stuck_current_a),
        progress_t_s_(start.t_s),
        low_current_t_s_(start.t_s) {}

  enum class Finding { fine, no_progress, overcurrent };
  // `remaining`: the distance to the goal, unsigned; counts as progress once it fell by `step`.
  Finding look(double remaining, const Estimate& now);
  double without_progress_s(const Estimate& now) const { return now.t_s - progress_t_s_; }
  // The goal was reached for now: what comes counts anew.
  void rest(const Estimate& now);

 private:
  double step_, stuck_time_s_, stuck_current_a_;
  double best_ = HUGE_VAL;
  double progress_t_s_, low_current_t_s_;
};

}  // namespace kenaf::hrt
