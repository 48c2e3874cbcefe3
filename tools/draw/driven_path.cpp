#include "tools/draw/driven_path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/draw/path_length.hpp"

namespace kenaf::draw {

namespace {

constexpr double kClimbHeight_m = 0.04;
constexpr double kClimbPitch_rad = 0.1;
constexpr double kFarthest_m = 1e6;  // beyond it a double resolves no robot's details

// The value of a column at each row, or the last one before.
class Channel {
 public:
  Channel(const runs::Run& run, const std::string& column, double value) : values_(run.column(column)), last_(value) {}

  bool measured(std::size_t row) const { return row < values_.size() && !std::isnan(values_[row]); }
  double at(std::size_t row) {
    if (measured(row)) last_ = values_[row];
    return last_;
  }
  double first_or(double otherwise) const {
    const auto found = std::ranges::find_if(values_, [](double value) { return !std::isnan(value); });
    return found == values_.end() ? otherwise : *found;
  }

 private:
  std::span<const double> values_;
  double last_;
};

double yaw_of(const Posture& posture) {
  return physics::roll_pitch_yaw(posture.X_WB.q).z();
}

}  // namespace

double DrivenPath::duration_s() const {
  return postures.back().time_s - postures.front().time_s;
}

double DrivenPath::length_m() const {
  std::vector<Eigen::Vector3d> p_WB;
  for (const Posture& posture : postures) p_WB.push_back(posture.X_WB.p);
  return path_length_m(p_WB);
}

Turns DrivenPath::turns() const {
  std::vector<double> yaw_rad;
  for (const Posture& posture : postures) yaw_rad.push_back(yaw_of(posture));
  return turns_of(yaw_rad);
}

double DrivenPath::start_to_end_m() const {
  return (postures.back().X_WB.p - postures.front().X_WB.p).head<2>().norm();
}

double DrivenPath::turned_rad() const {
  return std::remainder(yaw_of(postures.back()) - yaw_of(postures.front()), 2 * std::numbers::pi);
}

bool DrivenPath::climbs() const {
  const auto height = [](const Posture& posture) { return posture.X_WB.p.z(); };
  const auto [low, high] = std::ranges::minmax_element(postures, {}, height);
  return height(*high) - height(*low) > kClimbHeight_m || std::ranges::any_of(postures, [](const Posture& posture) {
           return std::abs(physics::roll_pitch_yaw(posture.X_WB.q).y()) > kClimbPitch_rad;
         });
}

DrivenPath driven_path(const runs::Run& run, const std::string& name, const physics::RobotDescription& robot) {
  const double start_rad = robot.has_flippers() ? robot.flipper.front().start_angle_rad : 0;
  // Without measured height the robot stands on the ground z = 0.
  const double resting_height_m = robot.ride_height_m();
  Channel x(run, "x_m", 0), y(run, "y_m", 0), z(run, "z_m", resting_height_m);
  Channel roll(run, "roll_rad", 0), pitch(run, "pitch_rad", 0), yaw(run, "yaw_rad", 0);
  std::vector<Channel> flippers;
  for (const std::string_view place : robot::kFlipperNames) {
    const std::string measured = "flipper_" + std::string(place) + "_rad";
    const std::string column = run.column(measured).empty() ? "cmd_" + measured : measured;
    flippers.emplace_back(run, column, Channel(run, column, start_rad).first_or(start_rad));
  }

  // A posture for each row with a position.
  DrivenPath path{name, {}};
  const std::span<const double> time_s = run.column("t_s");
  for (std::size_t row = 0; row < run.row_count(); ++row) {
    Posture posture{time_s[row], {}, {}};
    posture.X_WB.p = {x.at(row), y.at(row), z.at(row)};
    posture.X_WB.q = physics::rotation_from({roll.at(row), pitch.at(row), yaw.at(row)});
    for (std::size_t i = 0; i < flippers.size(); ++i) posture.flipper_rad[i] = flippers[i].at(row);
    if (!x.measured(row) || !y.measured(row)) continue;
    if (posture.X_WB.p.cwiseAbs().maxCoeff() > kFarthest_m) {
      throw runs::RunFileError(
          fmt::format("{}: at t_s = {} the robot is more than 1000 km from the origin", name, time_s[row]));
    }
    path.postures.push_back(posture);
  }
  if (path.postures.empty()) {
    throw runs::RunFileError(name + ": no row has both x_m and y_m; a run without positions cannot be drawn");
  }
  return path;
}

std::vector<std::size_t> spaced_postures(const DrivenPath& path, double spacing_m, double radius_m) {
  const auto distance = [&path, radius_m](std::size_t i, std::size_t j) {
    const physics::Pose &a = path.postures[i].X_WB, &b = path.postures[j].X_WB;
    return (a.p - b.p).norm() + radius_m * a.q.angularDistance(b.q);
  };
  const std::size_t last = path.postures.size() - 1;
  const auto choose = [&](double spacing) {
    std::vector<std::size_t> chosen{0};
    for (std::size_t i = 1; i < last; ++i) {
      if (distance(chosen.back(), i) >= spacing) chosen.push_back(i);
    }
    return chosen;
  };
  std::vector<std::size_t> chosen = choose(spacing_m);
  // The rest before the end is distributed over the steps.
  const double steps = static_cast<double>(chosen.size() - 1) + distance(chosen.back(), last) / spacing_m;
  const double whole_steps = std::max(1.0, std::round(steps));
  const double even_spacing_m = spacing_m * steps / whole_steps;
  if (even_spacing_m > 0) chosen = choose(even_spacing_m);
  while (chosen.size() > 1 && static_cast<double>(chosen.size()) > whole_steps) chosen.pop_back();
  if (last > 0) chosen.push_back(last);
  return chosen;
}

}  // namespace kenaf::draw
