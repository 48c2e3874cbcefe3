#include "hrt/motion.hpp"

#include <algorithm>
#include <numbers>

namespace kenaf::hrt {
namespace {

// While creeping, progress shows several times a second. After 0.3 s without any, each further 0.1 s adds 1.5 times the
// creeping speed.
constexpr double kPushAfter_s = 0.3;
constexpr double kPush_per_s = 15;

}  // namespace

MotionLimits motion_limits_from(const hrt_config& config) {
  constexpr double kMetres = 1e-3;
  constexpr double kRadians = std::numbers::pi / 180;
  return {
      .max_speed_mps = config.max_speed_mmps * kMetres,
      .acceleration_mps2 = config.acceleration_mmps2 * kMetres,
      .distance_tolerance_m = config.distance_tolerance_mm * kMetres,
      .max_turn_radps = config.max_turn_degps * kRadians,
      .turn_acceleration_radps2 = config.turn_acceleration_degps2 * kRadians,
      .angle_tolerance_rad = config.angle_tolerance_deg * kRadians,
      .stuck_time_s = config.stuck_time_s,
      .stuck_current_a = config.stuck_current_a,
      .track_gauge_m = config.track_gauge_mm * kMetres,
  };
}

double Approach::speed(double error, double before, double dt_s, double without_progress_s) const {
  const double remaining = std::abs(error);
  const double slowest =
      std::min(min_speed * (1 + kPush_per_s * std::max(0.0, without_progress_s - kPushAfter_s)), max_speed);
  const double profile = std::min({max_speed, std::sqrt(2 * acceleration * remaining), gain * remaining});
  // The profile min(v_max, sqrt(2 a e), gain e) brakes by itself; speeding up is limited to a dt a cycle.
  const bool turned_round = before * error < 0;
  const double reached = turned_round ? 0 : std::abs(before) + acceleration * dt_s;
  return std::copysign(std::max(slowest, std::min(profile, reached)), error);
}

double Approach::duration_s(double distance) const {
  const double ramp = max_speed * max_speed / acceleration;  // length of both ramps together
  const double profile = distance > ramp ? (distance - ramp) / max_speed + 2 * max_speed / acceleration
                                         : 2 * std::sqrt(distance / acceleration);
  // The exponential part takes longer than the ramp it replaces: add a few of its time constants.
  return profile + 5 / gain;
}

ProgressWatch::Finding ProgressWatch::look(double remaining, const Estimate& now) {
  if (remaining <= best_ - step_) {
    best_ = remaining;
    progress_t_s_ = now.t_s;
  }
  if (stuck_current_a_ <= 0 || !now.has_currents || now.max_track_a <= stuck_current_a_) low_current_t_s_ = now.t_s;
  if (now.t_s - low_current_t_s_ >= stuck_time_s_) return Finding::overcurrent;
  if (now.t_s - progress_t_s_ >= stuck_time_s_) return Finding::no_progress;
  return Finding::fine;
}

void ProgressWatch::rest(const Estimate& now) {
  best_ = HUGE_VAL;
  progress_t_s_ = now.t_s;
  low_current_t_s_ = now.t_s;
}

}  // namespace kenaf::hrt
