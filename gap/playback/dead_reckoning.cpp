#include "gap/playback/dead_reckoning.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hrt/estimate.hpp"

namespace kenaf::gap {
namespace {

bool any_measured(std::span<const double> column) {
  return std::ranges::any_of(column, [](double value) { return !std::isnan(value); });
}

bool has_travel(const runs::Run& run, std::string_view track) {
  return any_measured(run.column(fmt::format("track_{}_m", track))) ||
         any_measured(run.column(fmt::format("track_{}_mps", track)));
}

}  // namespace

std::vector<double> travel_of(const runs::Run& run, std::string_view track) {
  const auto time = run.column("t_s"), travel = run.column(fmt::format("track_{}_m", track)),
             speed = run.column(fmt::format("track_{}_mps", track));
  std::vector<double> result(time.size(), 0);
  if (any_measured(travel)) {
    for (std::size_t i = 0; i < result.size(); ++i)
      result[i] = !std::isnan(travel[i]) ? travel[i] : i > 0 ? result[i - 1] : 0;
  } else if (any_measured(speed)) {
    double speed_mps = 0;
    for (std::size_t i = 0; i < result.size(); ++i) {
      if (i > 0) result[i] = result[i - 1] + speed_mps * (time[i] - time[i - 1]);
      if (!std::isnan(speed[i])) speed_mps = speed[i];
    }
  }
  return result;
}

std::optional<ReckonedPath> reckon(const runs::Run& run, const physics::RobotDescription& robot) {
  if (!has_travel(run, "left") || !has_travel(run, "right")) return std::nullopt;
  const auto time = run.column("t_s"), roll = run.column("roll_rad"), pitch = run.column("pitch_rad"),
             yaw = run.column("yaw_rad");
  const std::array<std::vector<double>, relay::kTrackCount> travel{travel_of(run, "left"), travel_of(run, "right")};
  const auto first_yaw = std::ranges::find_if(yaw, [](double value) { return !std::isnan(value); });
  const double start_rad = first_yaw == yaw.end() ? 0 : *first_yaw;
  hrt::Estimator estimator({robot.track_gauge_m(), 1});
  ReckonedPath path;
  for (std::size_t i = 0; i < time.size(); ++i) {
    relay::State state{};
    state.frame = static_cast<std::uint32_t>(i + 1);
    state.robot_time_s = time[i] - time.front();
    state.fields = relay::kHasEncoders;
    state.track_m = {travel[0][i], travel[1][i]};
    if (!yaw.empty() && !std::isnan(yaw[i])) {
      const auto or_level = [i](std::span<const double> angle) {
        return angle.empty() || std::isnan(angle[i]) ? 0 : angle[i];
      };
      state.fields |= relay::kHasPosture;
      state.posture_rad = {or_level(roll), or_level(pitch), yaw[i]};
    }
    const hrt::Estimate& now = estimator.update(state);
    path.x_m.push_back(now.odometry_x_m * std::cos(start_rad) - now.odometry_y_m * std::sin(start_rad));
    path.y_m.push_back(now.odometry_x_m * std::sin(start_rad) + now.odometry_y_m * std::cos(start_rad));
    path.yaw_rad.push_back(start_rad + now.odometry_yaw_rad);
  }
  return path;
}

}  // namespace kenaf::gap
