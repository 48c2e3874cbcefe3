#include "hrt/motion_forward.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace kenaf::hrt {
namespace {

// 5/s: at the default limits the speed decays exponentially over the last 30 mm, to the default tolerance within a
// second.
constexpr double kDistanceGain_per_s = 5;
constexpr double kMinSpeed_mps = 0.003;
// Turn rate per heading error. Tracks slip when turning, so the real loop gain is lower and the loop cannot oscillate.
constexpr double kHeadingGain_per_s = 4;
// The heading correction may use this share of the forward speed, so that the robot stands still on arrival.
constexpr double kHeadingShare = 0.5;
// The tracks must stand for this long before the motion ends.
constexpr double kSettled_s = 0.05;

}  // namespace

GoForward::GoForward(const MotionLimits& limits, double distance_m, double heading_rad, const Estimate& start)
    : limits_(limits),
      approach_{limits.max_speed_mps, limits.acceleration_mps2, kDistanceGain_per_s,
                std::min(kMinSpeed_mps, limits.max_speed_mps)},
      distance_m_(distance_m),
      heading_rad_(heading_rad),
      start_travel_m_(start.travel_m),
      start_t_s_(start.t_s),
      time_limit_s_(3 * approach_.duration_s(std::abs(distance_m)) + 5),
      watch_(limits, 0.5 * limits.distance_tolerance_m, start) {}

MotionStep GoForward::step(const Estimate& now) {
  const double error_m = distance_m_ - (now.travel_m - start_travel_m_);
  const double remaining_m = std::abs(error_m);
  if (now.t_s - start_t_s_ > time_limit_s_) {
    return fail(HRT_E_TIMEOUT, now, fmt::format("the time limit of {:.1f} s was exceeded", time_limit_s_));
  }

  // The tracks stop within half of the tolerance; the other half is for coasting.
  holding_ = remaining_m <= (holding_ ? 1.0 : 0.5) * limits_.distance_tolerance_m;
  MotionStep result;
  if (holding_) {
    speed_mps_ = 0;
    watch_.rest(now);
    result.finished = now.still_s >= kSettled_s;
    return result;
  }
  switch (watch_.look(remaining_m, now)) {
    case ProgressWatch::Finding::no_progress:
      return fail(HRT_E_STUCK, now,
                  fmt::format("the track encoders show no progress for {:.1f} s", limits_.stuck_time_s));
    case ProgressWatch::Finding::overcurrent:
      return fail(HRT_E_STUCK, now, fmt::format("a track draws {:.1f} A, more than stuck_current_a", now.max_track_a));
    case ProgressWatch::Finding::fine:
      break;
  }

  speed_mps_ = approach_.speed(error_m, speed_mps_, now.dt_s, watch_.without_progress_s(now));
  const double share_mps = kHeadingShare * std::abs(speed_mps_);
  const double turn_mps = std::clamp(
      0.5 * limits_.track_gauge_m * kHeadingGain_per_s * (heading_rad_ - now.heading_rad), -share_mps, share_mps);
  result.track_speed_mps = {speed_mps_ - turn_mps, speed_mps_ + turn_mps};
  return result;
}

MotionStep GoForward::fail(int code, const Estimate& now, const std::string& why) const {
  return {.finished = true,
          .code = code,
          .text = fmt::format("hrt_go_forward: {} after {:.0f} mm of {:.0f} mm", why,
                              (now.travel_m - start_travel_m_) * 1e3, distance_m_ * 1e3)};
}

}  // namespace kenaf::hrt
