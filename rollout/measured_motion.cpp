#include "rollout/measured_motion.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "robot/angles.hpp"
#include "robot/parts.hpp"

namespace kenaf::rollout {
namespace {

constexpr double kTravelCounts_s = 0.1;  // interval over which speed is held to travel
constexpr double kMeanSpeed_s = 0.05;    // interval of mean speeds from travel alone
constexpr double kShare_m = 0.05;
constexpr double kCubic_s = 0.25, kBeyond_sigma = 4;
constexpr Eigen::Index kFewestPoses = 8;
constexpr double kStands_mps = 0.01, kStands_radps = 0.05;

TimeSeries series_of(const runs::Run& run, std::string_view column) {
  const auto time = run.column("t_s"), values = run.column(column);
  TimeSeries series;
  for (std::size_t row = 0; row < values.size(); ++row) {
    if (std::isnan(values[row])) continue;
    series.t_s.push_back(time[row] - time.front());
    series.value.push_back(values[row]);
  }
  return series;
}

TimeSeries without_full_turns(TimeSeries angle) {
  for (std::size_t i = 1; i < angle.value.size(); ++i)
    angle.value[i] = angle.value[i - 1] + robot::wrap_angle(angle.value[i] - angle.value[i - 1]);
  return angle;
}

// The integral of a series from its first point on: trapezoids, exact for linear pieces.
class Integral {
 public:
  explicit Integral(const TimeSeries& series) : series_(series) {
    for (std::size_t i = 0; i + 1 < series.t_s.size(); ++i)
      at_point_.push_back(at_point_.back() +
                          (series.t_s[i + 1] - series.t_s[i]) * (series.value[i] + series.value[i + 1]) / 2);
  }
  double to(double time_s) const {
    const auto& t = series_.t_s;
    if (time_s <= t.front()) return (time_s - t.front()) * series_.value.front();
    const auto i = static_cast<std::size_t>(std::ranges::upper_bound(t, time_s) - t.begin()) - 1;
    return at_point_[i] + (time_s - t[i]) * (series_.value[i] + series_.at(time_s)) / 2;
  }

 private:
  const TimeSeries& series_;
  std::vector<double> at_point_{0};
};

// Points of `series` at least `apart_s` from each other, the first one first.
std::vector<std::size_t> knots(const TimeSeries& series, double apart_s) {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < series.t_s.size(); ++i)
    if (out.empty() || series.t_s[i] >= series.t_s[out.back()] + apart_s - runs::kSameTime_s) out.push_back(i);
  return out;
}

TimeSeries mean_speeds(const TimeSeries& travel) {
  TimeSeries speed;
  const std::vector<std::size_t> at = knots(travel, kMeanSpeed_s);
  for (std::size_t k = 1; k < at.size(); ++k) {
    const double from_s = travel.t_s[at[k - 1]], to_s = travel.t_s[at[k]];
    speed.t_s.push_back((from_s + to_s) / 2);
    speed.value.push_back((travel.value[at[k]] - travel.value[at[k - 1]]) / (to_s - from_s));
  }
  return speed;
}

TimeSeries held_to_travel(const TimeSeries& speed, const TimeSeries& travel) {
  const std::vector<std::size_t> at = knots(travel, kTravelCounts_s);
  if (at.size() < 2) return speed;
  const Integral distance(speed);
  TimeSeries out;
  const auto add = [&out](double t_s, double value) {
    out.t_s.push_back(t_s);
    out.value.push_back(value);
  };

  // Before travel begins, the speed as it is.
  std::size_t i = 0;  // the next point of `speed`
  for (; i < speed.t_s.size() && speed.t_s[i] < travel.t_s[at.front()]; ++i) add(speed.t_s[i], speed.value[i]);

  // Between two knots a constant is added: (travel - integral of the speed) / duration. Both ends become points of
  // their own, so the series may jump there.
  for (std::size_t k = 1; k < at.size(); ++k) {
    const double from_s = travel.t_s[at[k - 1]], to_s = travel.t_s[at[k]];
    const double missing_m = travel.value[at[k]] - travel.value[at[k - 1]] - (distance.to(to_s) - distance.to(from_s));
    const double more_mps = missing_m / (to_s - from_s);
    add(from_s, speed.at(from_s) + more_mps);
    for (; i < speed.t_s.size() && speed.t_s[i] < to_s; ++i)
      if (speed.t_s[i] > from_s) add(speed.t_s[i], speed.value[i] + more_mps);
    add(to_s, speed.at(to_s) + more_mps);
  }

  // After travel ends, the speed as it is.
  for (; i < speed.t_s.size(); ++i) add(speed.t_s[i], speed.value[i]);
  return out;
}

TimeSeries track_travel(const runs::Run& run, std::string_view track) {
  return series_of(run, fmt::format("track_{}_m", track));
}

TimeSeries track_speed(const runs::Run& run, std::string_view track) {
  const TimeSeries travel = track_travel(run, track);
  TimeSeries speed = series_of(run, fmt::format("track_{}_mps", track));
  if (speed.empty()) speed = mean_speeds(travel);
  return speed.empty() ? speed : held_to_travel(speed, travel);
}

// The poses of a run's first `time_s` in which all three were measured.
struct Poses {
  std::vector<double> t_s, x_m, y_m, yaw_rad;  // since the first row; yaw without full turns
};

Poses first_poses(const runs::Run& run, double time_s) {
  const auto time = run.column("t_s"), x = run.column("x_m"), y = run.column("y_m"), yaw = run.column("yaw_rad");
  Poses poses;
  if (x.empty() || y.empty() || yaw.empty()) return poses;
  for (std::size_t row = 0; row < time.size() && time[row] - time.front() <= time_s + runs::kSameTime_s; ++row) {
    if (std::isnan(x[row]) || std::isnan(y[row]) || std::isnan(yaw[row])) continue;
    poses.t_s.push_back(time[row] - time.front());
    poses.x_m.push_back(x[row]);
    poses.y_m.push_back(y[row]);
    const double before = poses.yaw_rad.empty() ? yaw[row] : poses.yaw_rad.back();
    poses.yaw_rad.push_back(before + robot::wrap_angle(yaw[row] - before));
  }
  return poses;
}

// Least squares fit of k in b = constant + k a, k common to all columns: sum (a - mean) b / sum (a - mean)^2. Empty if
// the range of a is below `least`.
std::optional<double> slope(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, double least) {
  const Eigen::MatrixXd from_mean = a.rowwise() - a.colwise().mean();
  const Eigen::RowVectorXd spread = a.colwise().maxCoeff() - a.colwise().minCoeff();
  if (spread.norm() < least) return std::nullopt;
  return from_mean.cwiseProduct(b).sum() / from_mean.squaredNorm();
}

// Fits the body's motion to that of the tracks: yaw = c + k (right - left), and position = c + share * path, where path
// follows the mean of both tracks along the measured yaw. The start's rates are those of the tracks in the first row,
// times k and share.
StartMotion motion_of_tracks(const MeasuredMotion& measured, const Poses& poses,
                             const std::array<double, robot::kTrackCount>& track_mps) {
  StartMotion motion{.track_mps = track_mps, .forward_mps = {}, .yaw_radps = {}};
  const auto n = static_cast<Eigen::Index>(poses.t_s.size());
  if (n < 2) return motion;

  // For each pose: how far apart the tracks went, the yaw, the path and the position. The path's steps go along the
  // mean of the yaw before and after.
  const Integral left(measured.track_mps[robot::kLeft]), right(measured.track_mps[robot::kRight]);
  Eigen::MatrixXd apart_m(n, 1), yaw_rad(n, 1), way_m(n, 2), p_m(n, 2);
  double s_before_m = 0, yaw_before_rad = 0;
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double l = left.to(poses.t_s[k]), r = right.to(poses.t_s[k]), s_m = (l + r) / 2;
    apart_m(i) = r - l;
    yaw_rad(i) = poses.yaw_rad[k];
    p_m.row(i) << poses.x_m[k], poses.y_m[k];
    const double along = (poses.yaw_rad[k] + yaw_before_rad) / 2;
    if (i == 0)
      way_m.row(i).setZero();
    else
      way_m.row(i) = way_m.row(i - 1) + (s_m - s_before_m) * Eigen::RowVector2d(std::cos(along), std::sin(along));
    s_before_m = s_m;
    yaw_before_rad = poses.yaw_rad[k];
  }

  // The slopes; without one the rate stays unknown.
  if (const auto radpm = slope(apart_m, yaw_rad, kShare_m))
    motion.yaw_radps = *radpm * (track_mps[robot::kRight] - track_mps[robot::kLeft]);
  if (const auto share = slope(way_m, p_m, kShare_m))
    motion.forward_mps = std::clamp(*share, 0.0, 1.0) * (track_mps[robot::kLeft] + track_mps[robot::kRight]) / 2;
  return motion;
}

// Without tracks: slopes at t = 0 of cubics c0 + c1 t + c2 t^2 + c3 t^3 through the first poses, forward and yaw.
std::optional<StartMotion> motion_of_poses(const Poses& poses) {
  const auto n = static_cast<Eigen::Index>(poses.t_s.size());
  if (n < kFewestPoses) return std::nullopt;

  // Forward is along the first pose's heading.
  Eigen::MatrixXd powers(n, 4), where(n, 2);
  const double cos0 = std::cos(poses.yaw_rad[0]), sin0 = std::sin(poses.yaw_rad[0]);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double t = poses.t_s[k];
    powers.row(i) << 1, t, t * t, t * t * t;
    where.row(i) << cos0 * poses.x_m[k] + sin0 * poses.y_m[k], poses.yaw_rad[k];
  }

  // Ordinary least squares: c = (P^T P)^-1 P^T y; variance of c1 = residual sum of squares / (n - 4) * (P^T P)^-1_11.
  // A slope counts if it is beyond kBeyond_sigma and fast enough.
  const Eigen::Matrix4d covariance = (powers.transpose() * powers).inverse();
  const Eigen::MatrixXd fit = covariance * powers.transpose() * where;
  const Eigen::MatrixXd rest = where - powers * fit;
  const auto moves = [&](Eigen::Index quantity, double least) {
    const double variance = rest.col(quantity).squaredNorm() / static_cast<double>(n - 4) * covariance(1, 1);
    return std::abs(fit(1, quantity)) > std::max(least, kBeyond_sigma * std::sqrt(variance));
  };
  const bool drives = moves(0, kStands_mps), turns = moves(1, kStands_radps);
  if (!drives && !turns) return std::nullopt;
  return StartMotion{.track_mps = {}, .forward_mps = drives ? fit(1, 0) : 0, .yaw_radps = turns ? fit(1, 1) : 0};
}

}  // namespace

double TimeSeries::at(double time_s) const {
  const auto after = std::ranges::upper_bound(t_s, time_s);
  if (after == t_s.begin()) return value.front();
  if (after == t_s.end()) return value.back();
  const auto i = static_cast<std::size_t>(after - t_s.begin());
  return value[i - 1] + (value[i] - value[i - 1]) * (time_s - t_s[i - 1]) / (t_s[i] - t_s[i - 1]);
}

bool MeasuredMotion::empty() const {
  return std::ranges::all_of(track_mps, &TimeSeries::empty) && std::ranges::all_of(flipper_rad, &TimeSeries::empty);
}

physics::PrescribedMotion MeasuredMotion::at(double time_s, const ReportDelays& late) const {
  physics::PrescribedMotion motion;
  for (std::size_t i = 0; i < track_mps.size(); ++i) {
    const double track_late_s = is_held_to_travel[i] ? late.track_travel_s : late.track_speed_s;
    if (!track_mps[i].empty()) motion.track_mps[i] = track_mps[i].at(time_s + track_late_s);
  }
  for (std::size_t i = 0; i < flipper_rad.size(); ++i)
    if (!flipper_rad[i].empty()) motion.flipper_rad[i] = flipper_rad[i].at(time_s + late.flipper_s);
  return motion;
}

ReportDelays report_delays(const physics::RobotDescription& robot) {
  const auto delay_s = [&](physics::SensorType type) {
    const auto found = std::ranges::find(robot.sensors, type, &physics::SensorDescription::type);
    return found == robot.sensors.end() ? 0 : found->delay_s;
  };
  return {delay_s(physics::SensorType::tachometer), delay_s(physics::SensorType::encoder),
          delay_s(physics::SensorType::drives)};
}

physics::PrescribedMotion actual_motion(const MeasuredMotion& measured, double time_s,
                                        const physics::RobotDescription& robot, const ReportDelays& late) {
  physics::PrescribedMotion motion = measured.at(time_s, late);
  for (const robot::Track side : {robot::kLeft, robot::kRight})
    if (std::optional<double>& speed = motion.track_mps[side]) *speed /= robot.encoder_factor(side);
  return motion;
}

MeasuredMotion measured_motion(const runs::Run& run) {
  MeasuredMotion motion;
  for (std::size_t i = 0; i < robot::kTrackNames.size(); ++i) {
    motion.track_mps[i] = track_speed(run, robot::kTrackNames[i]);
    motion.is_held_to_travel[i] = !track_travel(run, robot::kTrackNames[i]).empty();
  }
  for (std::size_t i = 0; i < robot::kFlipperNames.size(); ++i)
    motion.flipper_rad[i] = without_full_turns(series_of(run, fmt::format("flipper_{}_rad", robot::kFlipperNames[i])));
  return motion;
}

std::array<double, robot::kTrackCount> without_encoder_errors(const physics::RobotDescription& robot,
                                                              std::array<double, robot::kTrackCount> reported_mps) {
  for (const robot::Track side : {robot::kLeft, robot::kRight}) reported_mps[side] /= robot.encoder_factor(side);
  return reported_mps;
}

BodyMotion body_motion(const physics::RobotDescription& robot, const StartMotion& start) {
  if (!start.track_mps) return {start.forward_mps.value_or(0), start.yaw_radps.value_or(0)};
  const auto [left, right] = without_encoder_errors(robot, *start.track_mps);
  const double without_slip_radps = (right - left) / robot.track_gauge_m();
  const auto [least, most] = std::minmax({0.0, without_slip_radps});
  return {start.forward_mps.value_or((left + right) / 2),
          std::clamp(start.yaw_radps.value_or(without_slip_radps), least, most)};
}

std::optional<StartMotion> motion_at_start(const runs::Run& run) {
  const MeasuredMotion measured = measured_motion(run);
  if (std::ranges::any_of(measured.track_mps, &TimeSeries::empty)) return motion_of_poses(first_poses(run, kCubic_s));
  std::array<double, robot::kTrackCount> track_mps{};
  for (std::size_t i = 0; i < track_mps.size(); ++i) track_mps[i] = measured.track_mps[i].at(0);
  if (std::ranges::all_of(track_mps, [](double speed) { return std::abs(speed) < kStands_mps; })) return std::nullopt;
  return motion_of_tracks(measured, first_poses(run, std::numeric_limits<double>::infinity()), track_mps);
}

}  // namespace kenaf::rollout
