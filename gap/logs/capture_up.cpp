#include "gap/logs/capture_up.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "gap/logs/course.hpp"

namespace kenaf::gap::logs {
namespace {

constexpr double kLiesAlong = 0.85, kFlatShare = 0.2, kTurnsAtLeast_rad = 0.5, kTurnsAtLeast_m = 0.1, kOtherTurn = 0.3,
                 kAsFarTurned = 0.6, kRises_m = 0.5, kSteep = 1.5;

Eigen::Quaterniond to_z_up(Up up) {
  const double angle = up == Up::y         ? 0.5 * std::numbers::pi
                       : up == Up::minus_y ? -0.5 * std::numbers::pi
                       : up == Up::minus_z ? std::numbers::pi
                                           : 0;
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitX()));
}

// The mean direction of the body's z axis.
Eigen::Vector3d mean_body_z(const MotionCapture& capture) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const CapturedPose& pose : capture.poses) sum += pose.q * Eigen::Vector3d::UnitZ();
  return sum / static_cast<double>(capture.poses.size());
}

// The turns about the body's axes, each from 0.
std::array<std::vector<double>, 3> turns_of(const MotionCapture& capture) {
  std::array<std::vector<double>, 3> turns{{{0}, {0}, {0}}};
  for (std::size_t i = 1; i < capture.poses.size(); ++i) {
    const Eigen::AngleAxisd step(capture.poses[i - 1].q.conjugate() * capture.poses[i].q);
    const Eigen::Vector3d turn = std::remainder(step.angle(), 2 * std::numbers::pi) * step.axis();
    for (std::size_t axis = 0; axis < 3; ++axis)
      turns[axis].push_back(turns[axis].back() + turn[static_cast<Eigen::Index>(axis)]);
  }
  return turns;
}

// The value farthest from the first one, less that.
double farthest(const std::vector<double>& values) {
  double result = 0;
  for (const double value : values)
    if (std::abs(value - values.front()) > std::abs(result)) result = value - values.front();
  return result;
}

// How far the robot turns to the left by its gyro, in rad, or by its tracks, in metres of their difference.
struct TurnOfRobot {
  double size;
  bool in_rad;
};
std::optional<TurnOfRobot> turn_of(const runs::Run& run) {
  const auto t_s = run.column("t_s");
  const auto turned = [&](std::span<const double> rate) {
    return farthest(course_of_rate(t_s, rate, longest_gap_s(median_step(t_s, rate))).value);
  };
  if (const auto gyro = run.column("gyro_z_radps"); runs::any_measured(gyro)) return TurnOfRobot{turned(gyro), true};
  const auto left = run.column("track_left_mps"), right = run.column("track_right_mps");
  if (!runs::any_measured(left) || !runs::any_measured(right)) return std::nullopt;
  std::vector<double> difference(left.size());
  for (std::size_t i = 0; i < difference.size(); ++i) difference[i] = right[i] - left[i];
  if (!runs::any_measured(difference)) return std::nullopt;
  return TurnOfRobot{turned(difference), false};
}

}  // namespace

std::string name_of(Up up) {
  return up == Up::y ? "y" : up == Up::minus_y ? "-y" : up == Up::minus_z ? "-z" : "z";
}

MotionCapture with_z_up(MotionCapture capture, Up up, const std::string& name_for_errors) {
  if (up == Up::z) return capture;
  if (!capture.has_z || !capture.has_tilt)
    throw runs::RunFileError(
        fmt::format("{}:1:1: {} up needs z and a quaternion qx, qy, qz, qw: angles do not say about "
                    "which axes",
                    name_for_errors, name_of(up)));
  const Eigen::Quaterniond turn = to_z_up(up);
  for (CapturedPose& pose : capture.poses) {
    pose.p_m = turn * pose.p_m;
    pose.q = turn * pose.q;
  }
  // with the body's axes turned likewise: q' = C q C^-1
  MotionCapture both = capture;
  for (CapturedPose& pose : both.poses) pose.q = pose.q * turn.conjugate();
  return mean_body_z(both).z() > mean_body_z(capture).z() ? both : capture;
}

std::optional<UpSeen> up_seen(const runs::Run& run, const MotionCapture& capture) {
  if (!capture.has_z || !capture.has_tilt || capture.poses.empty()) return std::nullopt;
  const Eigen::Vector3d body_z = mean_body_z(capture);
  for (const auto& [up, along] : {std::pair{Up::y, body_z.y()}, {Up::minus_y, -body_z.y()}, {Up::minus_z, -body_z.z()}})
    if (along > kLiesAlong)
      return UpSeen{up, fmt::format("the robot's z axis lies along {} most of the time", name_of(up))};

  // Places: how far each coordinate goes.
  Eigen::Vector3d least = capture.poses.front().p_m, most = least;
  for (const CapturedPose& pose : capture.poses) least = least.cwiseMin(pose.p_m), most = most.cwiseMax(pose.p_m);
  const Eigen::Vector3d goes = most - least;
  const bool y_stays = goes.y() < kFlatShare * std::max(goes.x(), goes.z()) && goes.y() < goes.z();

  // Turns: about y as the robot about its z axis, and hardly about z.
  const auto turns = turns_of(capture);
  const double about_y = farthest(turns[1]), about_z = farthest(turns[2]);
  const auto robot = turn_of(run);
  if (y_stays && robot && std::abs(about_y) > kTurnsAtLeast_rad && std::abs(about_z) < kOtherTurn * std::abs(about_y)) {
    const bool same = robot->in_rad ? std::abs(robot->size) > kAsFarTurned * std::abs(about_y) &&
                                          std::abs(about_y) > kAsFarTurned * std::abs(robot->size)
                                    : std::abs(robot->size) > kTurnsAtLeast_m;
    if (same)
      return UpSeen{
          (robot->size > 0) == (about_y > 0) ? Up::y : Up::minus_y,
          fmt::format("y changes by {:.2g} m only, x and z by {:.2g} and {:.2g} m, and the robot's turn of "
                      "{} is one of {:.2g} rad about y",
                      goes.y(), goes.x(), goes.z(),
                      fmt::format("{:.2g} {}", robot->size, robot->in_rad ? "rad" : "m of its tracks"), about_y)};
  }
  if (goes.z() > kRises_m && goes.z() > kSteep * std::max(goes.x(), goes.y()) && y_stays)
    return UpSeen{
        Up::y, fmt::format("z changes by {:.2g} m, x and y by {:.2g} and {:.2g} m only", goes.z(), goes.x(), goes.y())};
  return std::nullopt;
}

}  // namespace kenaf::gap::logs
