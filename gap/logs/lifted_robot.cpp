#include "gap/logs/lifted_robot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "gap/logs/course.hpp"

namespace kenaf::gap::logs {
namespace {

// Chosen.
constexpr double kFar_m = 0.5, kStays = 0.15, kMostSway = 0.3;
constexpr double kMostBias_radps = 0.05;  // of a gyro
constexpr std::size_t kFewestRuns = 3;

// Range of an angle after unwrapping.
double range_of_angle(std::span<const double> column) {
  std::vector<double> angles;
  for (const double angle : column) {
    if (std::isnan(angle)) continue;
    angles.push_back(angles.empty() ? angle
                                    : angles.back() + std::remainder(angle - angles.back(), 2 * std::numbers::pi));
  }
  return range(angles);
}

// The rows from the first pose to the last: beyond them nobody knows whether the body goes.
struct Rows {
  std::size_t first = 0, end = 0;
  std::span<const double> of(std::span<const double> column) const {
    return column.empty() ? column : column.subspan(first, end - first);
  }
};

Rows rows_with_pose(const runs::Run& run) {
  const auto x = run.column("x_m"), y = run.column("y_m");
  Rows rows;
  for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i) {
    if (std::isnan(x[i] + y[i])) continue;
    if (rows.end == 0) rows.first = i;
    rows.end = i + 1;
  }
  return rows;
}

// Range of the angle that the gyro turns through, without its bias: a mean rate so small that it may be one.
double range_of_gyro(const runs::Run& run, const Rows& rows) {
  const double forever_s = std::numeric_limits<double>::infinity();
  Course turned = course_of_rate(rows.of(run.column("t_s")), rows.of(run.column("gyro_z_radps")), forever_s);
  if (turned.t_s.size() < 2) return 0;
  const double mean_radps = (turned.value.back() - turned.value.front()) / (turned.t_s.back() - turned.t_s.front());
  if (std::abs(mean_radps) < kMostBias_radps)
    for (std::size_t i = 0; i < turned.value.size(); ++i) turned.value[i] -= mean_radps * turned.t_s[i];
  return range(turned.value);
}

// Range of left * left track + right * right track, as measured by travel or else speed.
double reach_of_tracks(const runs::Run& run, const Rows& rows, double left, double right) {
  for (const bool is_speed : {false, true}) {
    const char* unit = is_speed ? "mps" : "m";
    const auto a = rows.of(run.column(fmt::format("track_left_{}", unit))),
               b = rows.of(run.column(fmt::format("track_right_{}", unit)));
    if (a.empty() || b.empty()) continue;
    std::vector<double> sum(a.size());
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] = left * a[i] + right * b[i];
    const auto t_s = rows.of(run.column("t_s"));
    const double forever_s = std::numeric_limits<double>::infinity();
    const Course course = is_speed ? course_of_rate(t_s, sum, forever_s) : course_of(t_s, sum, forever_s);
    if (!course.value.empty()) return range(course.value);
  }
  return 0;
}

}  // namespace

void LiftedRobot::look_at(const runs::Run& run, double gauge_m) {
  const Rows rows = rows_with_pose(run);
  if (rows.end == 0) return;
  const double belts_m = std::max(reach_of_tracks(run, rows, 0.5, 0.5), reach_of_tracks(run, rows, -0.5, 0.5));
  if (belts_m < kFar_m) return;
  // The body's turn as the way that it takes at a track: half the gauge times the angle.
  const double turned_m = gauge_m / 2 * std::max(range_of_angle(run.column("yaw_rad")), range_of_gyro(run, rows));
  const double body_m = std::max(std::hypot(range(run.column("x_m")), range(run.column("y_m"))), turned_m);
  if (body_m >= kMostSway * belts_m) goes_ = true;
  ++runs_;
  belts_m_ += belts_m;
  body_m_ += body_m;
  most_belts_m_ = std::max(most_belts_m_, belts_m);
  most_body_m_ = std::max(most_body_m_, body_m);
}

std::optional<Finding> LiftedRobot::finding() const {
  if (goes_ || runs_ < kFewestRuns || body_m_ >= kStays * belts_m_) return std::nullopt;
  return Finding{
      Finding::Severity::dead, "dataset.toml", 0, "x_m",
      fmt::format(
          "the body moves less than {:.2g} m in all {} runs in which the tracks travel {:.2g} m and more, up to {:.2g} "
          "m: the robot is assumed to be lifted off the ground, and pose and gyro are ignored; leave them out",
          most_body_m_ + 0.005, runs_, kFar_m, most_belts_m_)};
}

void forget_body(runs::Run& run) {
  for (std::size_t c = 0; c < run.columns.size(); ++c) {
    const std::string& name = run.columns[c];
    const auto is_of = [&](std::string_view what) { return name.starts_with(what); };
    if (name == "x_m" || name == "y_m" || name == "z_m" || name == "roll_rad" || name == "pitch_rad" ||
        name == "yaw_rad" || is_of("posture_") || is_of("gyro_") || is_of("acc_"))
      std::ranges::fill(run.values[c], std::numeric_limits<double>::quiet_NaN());
  }
}

}  // namespace kenaf::gap::logs
