#include "hrt/motion_turn.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "hrt/presentation.hpp"

namespace kenaf::hrt {
namespace {

constexpr double kTurnGain_per_s = 4;
// Slow enough for heading smoothing and drive lag to stay within half of the tolerance.
constexpr double kMinTrackSpeed_mps = 0.003;
// The smoothed heading must settle before it is trusted: several of its time constants.
constexpr double kTurnSettled_s = 0.15;

}  // namespace

TurnInPlace::TurnInPlace(const MotionLimits& limits, double goal_rad, const Estimate& start)
    : limits_(limits),
      approach_{limits.max_turn_radps, limits.turn_acceleration_radps2, kTurnGain_per_s,
                std::min(2 * kMinTrackSpeed_mps / limits.track_gauge_m, limits.max_turn_radps)},
      goal_rad_(goal_rad),
      start_heading_rad_(start.heading_rad),
      start_t_s_(start.t_s),
      time_limit_s_(5 * approach_.duration_s(std::abs(goal_rad - start.heading_rad)) + 5),
      watch_(limits, 0.5 * limits.angle_tolerance_rad, start) {}

MotionStep TurnInPlace::step(const Estimate& now) {
  // Both angles are unwrapped: a turn of more than 180 degrees is an ordinary distance.
  const double error_rad = goal_rad_ - now.heading_rad;
  const double remaining_rad = std::abs(error_rad);
  if (now.t_s - start_t_s_ > time_limit_s_) {
    return fail(HRT_E_TIMEOUT, now, fmt::format("the time limit of {:.1f} s was exceeded", time_limit_s_));
  }

  // Within the band the tracks stand: entered at half of the tolerance, left at all of it, so that noise does not
  // switch it on and off. The motion ends once they have stood long enough.
  holding_ = remaining_rad <= (holding_ ? 1.0 : 0.5) * limits_.angle_tolerance_rad;
  MotionStep result;
  if (holding_) {
    turn_radps_ = 0;
    watch_.rest(now);
    result.finished = now.still_s >= kTurnSettled_s;
    return result;
  }

  // Outside of it the error has to shrink, and the current has to stay below the limit.
  switch (watch_.look(remaining_rad, now)) {
    case ProgressWatch::Finding::no_progress:
      return fail(HRT_E_STUCK, now, fmt::format("the heading shows no progress for {:.1f} s", limits_.stuck_time_s));
    case ProgressWatch::Finding::overcurrent:
      return fail(HRT_E_STUCK, now, fmt::format("a track draws {:.1f} A, more than stuck_current_a", now.max_track_a));
    case ProgressWatch::Finding::fine:
      break;
  }

  // The rate of the approach profile; turning in place, the tracks run at -+ gauge / 2 * rate.
  turn_radps_ = approach_.speed(error_rad, turn_radps_, now.dt_s, watch_.without_progress_s(now));
  const double track_mps = 0.5 * limits_.track_gauge_m * turn_radps_;
  result.track_speed_mps = {-track_mps, track_mps};
  return result;
}

MotionStep TurnInPlace::fail(int code, const Estimate& now, const std::string& why) const {
  return {.finished = true,
          .code = code,
          .text = fmt::format("hrt_turning: {} after {:.1f} degrees of {:.1f}", why,
                              (now.heading_rad - start_heading_rad_) * kDegrees,
                              (goal_rad_ - start_heading_rad_) * kDegrees)};
}

}  // namespace kenaf::hrt
