// The quantities that a run and a motion capture both measured: merge_pose.hpp.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "gap/logs/merge_pose.hpp"
#include "physics/pose.hpp"

namespace kenaf::gap::logs {
namespace {

// Gains that robots have: a gyro, an orientation sensor or another pose agrees with motion capture; belts slip; and
// with slip the difference of the track speeds turns a robot far less than without. Gauges from 0.1 to 2 m.
constexpr double kLeastGain = 0.8, kMostGain = 1.25;
constexpr double kLeastBelt = 0.5, kMostBelt = 3;
constexpr double kLeastGauge_m = 0.1, kMostGauge_m = 10;
constexpr double kEnough_rad = 0.1, kEnough_m = 0.05;

constexpr std::array<const char*, 3> kAxes = {"x", "y", "z"};

// The turns about the body's axes and the travel along its x axis, accumulated.
struct BodyCourses {
  std::array<Course, 3> turn;
  Course forward;
};

struct Poses {
  std::vector<double> t_s;
  std::vector<Eigen::Vector3d> p;
  std::vector<Eigen::Quaterniond> q;
};

BodyCourses courses_of(const Poses& poses) {
  BodyCourses courses;
  const double gap_s = longest_gap_s(median_step(poses.t_s, poses.t_s));
  for (Course* course : {&courses.turn[0], &courses.turn[1], &courses.turn[2], &courses.forward})
    *course = {poses.t_s, {0}, gap_s};
  for (std::size_t i = 1; i < poses.t_s.size(); ++i) {
    // The rotation vector of q_(i-1)^-1 q_i is the turn in the body's frame; the travel is the displacement along the
    // body's x axis half way between both rotations.
    const Eigen::AngleAxisd step(poses.q[i - 1].conjugate() * poses.q[i]);
    // AngleAxis has angles from 0 to 2 pi; the remainder is the shorter way round.
    const Eigen::Vector3d turn = std::remainder(step.angle(), 2 * std::numbers::pi) * step.axis();
    const Eigen::Vector3d forward = poses.q[i - 1].slerp(0.5, poses.q[i]) * Eigen::Vector3d::UnitX();
    for (std::size_t axis = 0; axis < 3; ++axis)
      courses.turn[axis].value.push_back(courses.turn[axis].value.back() + turn[static_cast<Eigen::Index>(axis)]);
    courses.forward.value.push_back(courses.forward.value.back() + forward.dot(poses.p[i] - poses.p[i - 1]));
  }
  if (poses.t_s.empty()) courses = {};
  return courses;
}

Poses poses_of(const MotionCapture& capture) {
  Poses poses;
  for (const CapturedPose& pose : capture.poses) {
    poses.t_s.push_back(pose.t_s);
    poses.p.push_back(pose.p_m);
    poses.q.push_back(pose.q);
  }
  return poses;
}

// The rows of a run in which all columns asked for were measured. Roll and pitch are 0 without `tilt`, x and y without
// `place`.
Poses poses_of(const runs::Run& run, const std::string& angle_prefix, bool tilt, bool place) {
  const auto column = [&run](const std::string& name) { return run.column(name); };
  const auto t = column("t_s"), x = column("x_m"), y = column("y_m"), yaw = column(angle_prefix + "yaw_rad"),
             roll = column(angle_prefix + "roll_rad"), pitch = column(angle_prefix + "pitch_rad");
  Poses poses;
  for (std::size_t row = 0; row < yaw.size(); ++row) {
    const Eigen::Vector3d p(place ? x[row] : 0, place ? y[row] : 0, 0);
    const Eigen::Vector3d rpy(tilt ? roll[row] : 0, tilt ? pitch[row] : 0, yaw[row]);
    if (!p.allFinite() || !rpy.allFinite()) continue;
    poses.t_s.push_back(t[row]);
    poses.p.push_back(p);
    poses.q.push_back(physics::rotation_from(rpy));
  }
  return poses;
}

// The weighted sum of two columns; NaN where either is.
std::vector<double> combined(std::span<const double> left, std::span<const double> right, double of_left,
                             double of_right) {
  std::vector<double> sum(std::min(left.size(), right.size()));
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] = of_left * left[i] + of_right * right[i];
  return sum;
}

}  // namespace

std::vector<CourseSeenTwice> courses_seen_twice(const runs::Run& run, const MotionCapture& capture) {
  const BodyCourses captured = courses_of(poses_of(capture));
  const auto t_s = run.column("t_s");
  std::vector<CourseSeenTwice> seen;
  bool has_turn = false;
  // A quantity needs two samples of the robot; without tilt the capture measured turns about z alone.
  const auto add = [&](const std::string& name, Course robot, const Course& other, double least, double most,
                       double enough, bool slips) {
    if (robot.t_s.size() >= 2) seen.push_back({name, std::move(robot), other, least, most, enough, slips});
  };
  const auto add_turn = [&](std::size_t axis, const std::string& from, Course robot) {
    if (axis < 2 && !capture.has_tilt) return;
    has_turn = has_turn || (axis == 2 && robot.t_s.size() >= 2);
    add(fmt::format("turn about {} ({})", kAxes[axis], from), std::move(robot), captured.turn[axis], kLeastGain,
        kMostGain, kEnough_rad, false);
  };

  // Turns come from the best sensor there is: the gyro, else the orientation sensor, else the run's own pose.
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string name = std::string("gyro_") + kAxes[axis] + "_radps";
    const auto rate = run.column(name);
    if (runs::any_measured(rate))
      add_turn(axis, name, course_of_rate(t_s, rate, longest_gap_s(median_step(t_s, rate))));
  }
  for (const std::string prefix : {"posture_", ""}) {
    if (has_turn) break;
    const bool tilt =
        runs::any_measured(run.column(prefix + "roll_rad")) && runs::any_measured(run.column(prefix + "pitch_rad"));
    const BodyCourses courses = courses_of(poses_of(run, prefix, tilt, false));
    for (std::size_t axis = tilt ? 0 : 2; axis < 3; ++axis) add_turn(axis, prefix + "yaw_rad", courses.turn[axis]);
  }

  // Travel from the tracks, as a distance or else integrated from speeds; their difference gives turns only if no
  // sensor did.
  const auto add_belts = [&](const std::string& unit, bool adds_up) {
    const auto left = run.column("track_left_" + unit), right = run.column("track_right_" + unit);
    const auto course = [&](double of_left, double of_right) {
      const std::vector<double> sum = combined(left, right, of_left, of_right);
      const double gap_s = longest_gap_s(median_step(t_s, sum));
      return adds_up ? course_of(t_s, sum, gap_s) : course_of_rate(t_s, sum, gap_s);
    };
    Course travel = course(0.5, 0.5);
    if (travel.t_s.size() < 2) return false;
    const std::string from = "track_left_" + unit + ", track_right_" + unit;
    add("travel (" + from + ")", std::move(travel), captured.forward, kLeastBelt, kMostBelt, kEnough_m, true);
    if (!has_turn)
      add("turn by the tracks (" + from + ")", course(-1, 1), captured.turn[2], kLeastGauge_m, kMostGauge_m, kEnough_m,
          true);
    return true;
  };

  // Without tracks the run's own pose gives the travel.
  if (!add_belts("m", true) && !add_belts("mps", false) && !run.column("x_m").empty() && !run.column("y_m").empty())
    add("travel (x_m, y_m)", courses_of(poses_of(run, "", false, true)).forward, captured.forward, kLeastGain,
        kMostGain, kEnough_m, false);
  return seen;
}

}  // namespace kenaf::gap::logs
