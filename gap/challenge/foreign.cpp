#include "gap/challenge/foreign.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace kenaf::gap {
namespace {

std::vector<double>* column_of(runs::Run& run, std::string_view name) {
  for (std::size_t c = 0; c < run.columns.size(); ++c)
    if (run.columns[c] == name) return &run.values[c];
  return nullptr;
}

// As it was `delay_s` before, the first value before that.
void delay(std::vector<double>& column, const std::vector<double>& time_s, double delay_s) {
  std::vector<double> known_t_s, known;
  for (std::size_t i = 0; i < column.size(); ++i)
    if (!std::isnan(column[i])) known_t_s.push_back(time_s[i]), known.push_back(column[i]);
  if (known.empty()) return;
  for (std::size_t i = 0; i < column.size(); ++i) {
    if (std::isnan(column[i])) continue;
    const double at_s = time_s[i] - delay_s;
    const auto after = std::ranges::upper_bound(known_t_s, at_s) - known_t_s.begin();
    if (after == 0) {
      column[i] = known.front();
      continue;
    }
    const auto k = static_cast<std::size_t>(after);
    if (k == known.size()) continue;
    const double share = (at_s - known_t_s[k - 1]) / (known_t_s[k] - known_t_s[k - 1]);
    column[i] = known[k - 1] + share * (known[k] - known[k - 1]);
  }
}

void follow_late(rollout::Manoeuvre& replay, std::size_t track, double lag_s) {
  double followed_mps = 0, last_s = 0;
  for (rollout::TimedCommand& timed : replay.timed) {
    double& command_mps = timed.command.track_speed_mps[track];
    followed_mps += (command_mps - followed_mps) * -std::expm1(-(timed.t_s - last_s) / lag_s);
    last_s = timed.t_s;
    command_mps = followed_mps;
  }
}

}  // namespace

physics::RobotDescription with_foreign(physics::RobotDescription robot, std::string_view foreign, double amount) {
  if (foreign == "track_gauge") robot.track.p_BT_m.y() *= 1 + 0.15 * amount;
  if (foreign == "servo_speed") robot.servo.max_speed_radps *= 1 - 0.6 * amount;
  if (foreign == "flipper_length")
    for (physics::FlipperDescription& flipper : robot.flipper) flipper.length_m *= 1 + 0.3 * amount;
  return robot;
}

void obey_foreign(rollout::Manoeuvre& replay, std::string_view foreign, double amount) {
  if (foreign == "left_drive_lag") follow_late(replay, 0, 0.3 * amount);
  if (foreign == "command_dead_band")
    for (rollout::TimedCommand& timed : replay.timed)
      for (double& speed_mps : timed.command.track_speed_mps)
        speed_mps = std::copysign(std::max(0.0, std::abs(speed_mps) - 0.08 * amount), speed_mps);
}

void record_foreign(runs::Run& run, std::string_view foreign, double amount) {
  const std::vector<double> time_s = *column_of(run, "t_s");
  const auto each = [&](std::initializer_list<const char*> names, auto&& change) {
    for (const char* name : names)
      if (std::vector<double>* column = column_of(run, name)) change(*column);
  };
  if (foreign == "pose_scale")
    each({"x_m", "y_m"}, [&](std::vector<double>& column) {
      const double origin = column.front();
      for (double& value : column) value = origin + (value - origin) * (1 + 0.1 * amount);
    });
  if (foreign == "pose_delay")
    each({"x_m", "y_m", "z_m", "yaw_rad"}, [&](std::vector<double>& column) { delay(column, time_s, 0.3 * amount); });
  if (foreign == "gyro_scale")
    each({"gyro_x_radps", "gyro_y_radps", "gyro_z_radps"}, [&](std::vector<double>& column) {
      for (double& value : column) value *= 1 + 0.2 * amount;
    });
}

}  // namespace kenaf::gap
