// Shared by the motion primitives: limits, result, and the speed profile towards a goal.
#pragma once

#include <array>
#include <cmath>
#include <string>

#include "hrt/estimate.hpp"
#include "kenaf/hrt.h"
#include "robot/parts.hpp"

namespace kenaf::hrt {

// The motion part of hrt_config in SI units.
struct MotionLimits {
  double max_speed_mps, acceleration_mps2, distance_tolerance_m;
  double max_turn_radps, turn_acceleration_radps2, angle_tolerance_rad;
  double stuck_time_s, stuck_current_a;
  double track_gauge_m;
};
MotionLimits motion_limits_from(const hrt_config& config);

// The command of a motion in a cycle, and whether the motion is finished.
struct MotionStep {
  std::array<double, robot::kTrackCount> track_speed_mps{};
  bool finished = false;
  int code = HRT_OK;  // once finished
  std::string text;   // why it failed
};

// Speed profile towards a goal: a trapezoid that ends exponentially, so that neither the cycle's delay nor the drive's
// lag overshoots the goal. All in the unit of the distance: metres or radians.
struct Approach {
  double max_speed, acceleration;
  double gain;       // 1/s: decay rate of the exponential part
  double min_speed;  // lowest speed outside the goal's tolerance band

  // Returns the speed for a signed `error` to the goal, `dt_s` after `before` was commanded. A motion without progress
  // for `without_progress_s` pushes harder: a speed too low to overcome friction or a drive's dead band grows until it
  // does.
  double speed(double error, double before, double dt_s, double without_progress_s = 0) const;
  // Returns the time of the profile over `distance` from standstill to standstill.
  double duration_s(double distance) const;
};

// Detects whether a motion makes progress. One for each motion.
class ProgressWatch {
 public:
  ProgressWatch(const MotionLimits& limits, double step, const Estimate& start)
      : step_(step),
        stuck_time_s_(limits.stuck_time_s),
        stuck_current_a_(limits.stuck_current_a),
        progress_t_s_(start.t_s),
        low_current_t_s_(start.t_s) {}

  enum class Finding { fine, no_progress, overcurrent };
  // `remaining`: unsigned distance to the goal; counts as progress when it has fallen by `step`.
  Finding look(double remaining, const Estimate& now);
  double without_progress_s(const Estimate& now) const { return now.t_s - progress_t_s_; }
  // The goal is reached for now: progress is counted anew from here.
  void rest(const Estimate& now);

 private:
  double step_, stuck_time_s_, stuck_current_a_;
  double best_ = HUGE_VAL;
  double progress_t_s_, low_current_t_s_;
};

}  // namespace kenaf::hrt
