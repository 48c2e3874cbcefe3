#include "gap/playback/dead_reckoning.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gap/playback/columns_in_time.hpp"
#include "hrt/estimate.hpp"
#include "robot/state.hpp"

namespace kenaf::gap::playback {
namespace {

constexpr std::array<std::string_view, 3> kAngleColumns{"roll_rad", "pitch_rad", "yaw_rad"};

bool has_travel(const runs::Run& run, std::string_view track) {
  return runs::any_measured(run.column(fmt::format("track_{}_m", track))) ||
         runs::any_measured(run.column(fmt::format("track_{}_mps", track)));
}

// An angle of the pose, else of the robot's own sensor, interpolated at each row: the estimator takes a sensor that is
// slower than kPostureLost_s for lost.
std::vector<double> angle_of(const runs::Run& run, std::string_view column, std::span<const double> since_start_s) {
  std::vector<double> angle_rad = column_at(run, column, since_start_s);
  return angle_rad.empty() ? column_at(run, fmt::format("posture_{}", column), since_start_s) : angle_rad;
}

}  // namespace

std::vector<double> travel_of(const runs::Run& run, std::string_view track) {
  const auto time = run.column("t_s"), travel = run.column(fmt::format("track_{}_m", track)),
             speed = run.column(fmt::format("track_{}_mps", track));
  std::vector<double> result(time.size(), 0);
  if (runs::any_measured(travel)) {
    double last_m = *std::ranges::find_if(travel, [](double value) { return !std::isnan(value); });
    for (std::size_t i = 0; i < result.size(); ++i) result[i] = last_m = std::isnan(travel[i]) ? last_m : travel[i];
  } else if (runs::any_measured(speed)) {
    // Each speed holds until the next one.
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
  const auto time = run.column("t_s"), yaw = run.column("yaw_rad");
  const std::array<std::vector<double>, robot::kTrackCount> travel{travel_of(run, "left"), travel_of(run, "right")};
  // The inputs of each row: travel of both tracks, and angles where they are known.
  const auto first_yaw = std::ranges::find_if(yaw, [](double value) { return !std::isnan(value); });
  const double start_rad = first_yaw == yaw.end() ? 0 : *first_yaw;
  std::vector<double> since_start_s;
  for (const double t_s : time) since_start_s.push_back(t_s - time.front());
  std::array<std::vector<double>, 3> angle_rad;
  for (std::size_t i = 0; i < angle_rad.size(); ++i) angle_rad[i] = angle_of(run, kAngleColumns[i], since_start_s);

  // The library's own estimator runs over the rows as if they were states of the robot.
  hrt::Estimator estimator({robot.track_gauge_m(), 1});
  ReckonedPath path;
  for (std::size_t i = 0; i < time.size(); ++i) {
    // A row with a heading has a posture; unmeasured roll and pitch count as level.
    robot::State state{};
    state.frame = static_cast<std::uint32_t>(i + 1);
    state.robot_time_s = since_start_s[i];
    state.fields = robot::kHasEncoders;
    state.track_m = {travel[0][i], travel[1][i]};
    if (const auto& heading_rad = angle_rad[2]; !heading_rad.empty() && !std::isnan(heading_rad[i])) {
      const auto or_level = [i](std::span<const double> angle) {
        return angle.empty() || std::isnan(angle[i]) ? 0 : angle[i];
      };
      state.fields |= robot::kHasPosture;
      state.posture_rad = {or_level(angle_rad[0]), or_level(angle_rad[1]), heading_rad[i]};
    }

    // Odometry starts at heading 0; Rz(start) turns it into W.
    const hrt::Estimate& now = estimator.update(state);
    path.x_m.push_back(now.odometry_x_m * std::cos(start_rad) - now.odometry_y_m * std::sin(start_rad));
    path.y_m.push_back(now.odometry_x_m * std::sin(start_rad) + now.odometry_y_m * std::cos(start_rad));
    path.yaw_rad.push_back(start_rad + now.odometry_yaw_rad);
  }
  return path;
}

}  // namespace kenaf::gap::playback
