#include "hrt/estimate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "robot/angles.hpp"
#include "robot/state.hpp"

namespace kenaf::hrt {
namespace {

// This time constant reduces an orientation sensor's white noise of 0.1 degrees in 10 ms cycles to 0.03 degrees, while
// the lag stays far below what affects the last, slow part of a turn.
constexpr double kHeadingSmoothing_s = 0.05;

// Thirty years: the difference of two such times in nanoseconds still fits 64 bits.
constexpr double kLongest_s = 1e9;

// An orientation sensor that is silent for longer counts as lost.
constexpr double kPostureLost_s = 0.25;

// Travel below this is encoder resolution, not motion.
constexpr double kStillTravel_m = 0.00025;

}  // namespace

const Estimate& Estimator::update(const robot::State& state) {
  Estimate& now = estimate_;
  const bool first = !started_;
  now.frame = state.frame;
  // The clock's zero is arbitrary: in whole nanoseconds since the first cycle, identical runs have identical times to
  // the last bit, whenever they begin.
  const std::int64_t t_ns = std::llround(std::clamp(state.robot_time_s, -kLongest_s, kLongest_s) * 1e9);
  if (first) t_ns_ = t_ns;
  // A clock that was set back gives no interval for this cycle; the next cycle is measured from it.
  const std::int64_t dt_ns = std::max<std::int64_t>(0, t_ns - t_ns_);
  now.world_was_reset = t_ns < t_ns_;
  // Encoders and orientation begin anew: the step from their last values to these is no motion.
  if (now.world_was_reset) {
    has_travel_ = has_posture_ = false;
    posture_gap_s_ = gap_turn_rad_ = 0;
  }
  t_ns_ = t_ns;
  passed_ns_ += std::min(dt_ns, std::numeric_limits<std::int64_t>::max() - passed_ns_);
  now.dt_s = static_cast<double>(dt_ns) * 1e-9;
  now.t_s = static_cast<double>(passed_ns_) * 1e-9;
  now.has_encoders = (state.fields & robot::kHasEncoders) != 0;
  now.has_currents = (state.fields & robot::kHasCurrents) != 0;
  if (now.has_currents) {
    now.max_track_a = std::max(std::abs(state.track_a[robot::kLeft]), std::abs(state.track_a[robot::kRight]));
  }

  // Travel of each track since the previous cycle; zero if it was not measured.
  std::array<double, robot::kTrackCount> moved_m{};
  if (now.has_encoders) {
    for (std::size_t i = 0; i < robot::kTrackCount; ++i) {
      moved_m[i] = has_travel_ ? state.track_m[i] - track_m_[i] : 0;
      track_m_[i] = state.track_m[i];
    }
    has_travel_ = true;
    now.travel_m = 0.5 * (track_m_[robot::kLeft] + track_m_[robot::kRight]);
  }

  // Heading: unwrapped and smoothed orientation sensor if available, else from the encoders.
  const double before_rad = now.heading_rad;
  const double turned_rad =
      (moved_m[robot::kRight] - moved_m[robot::kLeft]) / settings_.track_gauge_m * settings_.turn_efficiency;
  if ((state.fields & robot::kHasPosture) != 0) {
    if (first) {
      raw_heading_rad_ = now.heading_rad = start_heading_rad_ = state.posture_rad[2];
    } else if (!has_posture_ || posture_gap_s_ > kPostureLost_s) {
      // the sensor starts late, or again, at an arbitrary heading: the robot's heading continues from where the
      // encoders brought it, so that a motion under way sees no jump
      posture_offset_rad_ = before_rad - state.posture_rad[2];
      raw_heading_rad_ = before_rad;
    } else {
      raw_heading_rad_ += robot::wrap_angle(state.posture_rad[2] + posture_offset_rad_ - raw_heading_rad_);
      const double since_last_s = posture_gap_s_ + now.dt_s;
      now.heading_rad += (raw_heading_rad_ - now.heading_rad) * -std::expm1(-since_last_s / kHeadingSmoothing_s);
    }
    has_posture_ = true;
    posture_gap_s_ = gap_turn_rad_ = 0;
  } else if (!has_posture_) {
    now.heading_rad += turned_rad;
  } else {
    // a sensor slower than the cycle leaves short gaps, over which the heading is held
    posture_gap_s_ += now.dt_s;
    gap_turn_rad_ += turned_rad;
    if (posture_gap_s_ > kPostureLost_s) now.heading_rad += std::exchange(gap_turn_rad_, 0);
  }

  // Odometry along the mean heading of the step; with an orientation sensor, the travel is projected onto the
  // horizontal.
  const double yaw_rad = now.heading_rad - start_heading_rad_;
  const double mean_rad = first ? yaw_rad : 0.5 * (yaw_rad + now.odometry_yaw_rad);
  const double slope_rad = (state.fields & robot::kHasPosture) != 0 ? state.posture_rad[1] : 0;
  const double advance_m = 0.5 * (moved_m[robot::kLeft] + moved_m[robot::kRight]) * std::cos(slope_rad);
  now.odometry_x_m += advance_m * std::cos(mean_rad);
  now.odometry_y_m += advance_m * std::sin(mean_rad);
  now.odometry_yaw_rad = yaw_rad;

  const bool moved = std::abs(track_m_[robot::kLeft] - still_track_m_[robot::kLeft]) > kStillTravel_m ||
                     std::abs(track_m_[robot::kRight] - still_track_m_[robot::kRight]) > kStillTravel_m;
  if (first || moved) {
    still_track_m_ = track_m_;
    now.still_s = 0;
  } else {
    now.still_s += now.dt_s;
  }
  started_ = true;
  return now;
}

}  // namespace kenaf::hrt
