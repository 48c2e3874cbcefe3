#include "tools/studies/validation/limits.hpp"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "physics/world.hpp"

namespace kenaf::validation {
namespace {

using physics::Pose;
using physics::RobotDescription;
using physics::World;
using physics::WorldDescription;

constexpr double kDegrees = 180 / std::numbers::pi;

RobotDescription plain(const char* name, double friction) {
  RobotDescription robot = physics::load_robot(name);
  robot.flipper.clear();
  robot.drive.max_force_n = 1e4;
  for (physics::TrackDescription& track : robot.track) {
    track.friction_along = track.friction_across = friction;
    track.lug_height_m = 0;
  }
  return robot;
}

// The value between `passes` and `fails` at which the outcome changes, to 1/1000 of their distance.
double boundary(double passes, double fails, const std::function<bool(double)>& try_at) {
  for (int i = 0; i < 10; ++i) {
    const double middle = (passes + fails) / 2;
    (try_at(middle) ? passes : fails) = middle;
  }
  return (passes + fails) / 2;
}

struct Climb {
  World world;
  physics::RobotId id;
  double start_x_m;

  Climb(const WorldDescription& description, const RobotDescription& robot, const Pose& X_WB)
      : world(description, {}, 1), id(world.add_robot(robot, "robot", X_WB)), start_x_m(X_WB.p.x()) {}
  void drive(double speed_mps, double time_s) {
    robot::Command command;
    command.track_speed_mps = {speed_mps, speed_mps};
    world.set_command(id, command);
    for (long i = 0; i < std::lround(time_s / world.settings().time_step_s); ++i) world.step();
  }
  Eigen::Vector3d rpy() const { return physics::roll_pitch_yaw(world.truth(id).X_WB.q); }
  double moved_m() const { return world.truth(id).X_WB.p.x() - start_x_m; }
};

// A plane that rises forward by `pitch_rad`, or to the left by `roll_rad`, with the robot on it.
Climb on_slope(const RobotDescription& robot, double pitch_rad, double roll_rad) {
  WorldDescription world;
  const Pose X_WP{Eigen::Vector3d::Zero(), physics::rotation_from({roll_rad, -pitch_rad, 0})};
  world.planes.push_back({X_WP, 1});
  return {world, robot, compose(X_WP, {{0, 0, robot.ride_height_m()}, Eigen::Quaterniond::Identity()})};
}

bool holds(const RobotDescription& robot, double slope_rad) {
  Climb climb = on_slope(robot, slope_rad, 0);
  climb.drive(0, 2);
  return std::abs(climb.moved_m()) < 0.02;
}

bool stays_upright(const RobotDescription& robot, double pitch_rad, double roll_rad) {
  Climb climb = on_slope(robot, pitch_rad, roll_rad);
  climb.drive(0, 3);
  return std::abs(climb.rpy().x() - roll_rad) < 0.1 && std::abs(climb.rpy().y() + pitch_rad) < 0.1;
}

ComparisonRow tipping(const char* name, bool sideways) {
  const RobotDescription robot = plain(name, 10);
  const double up_m = robot.ride_height_m() + robot.body.p_BBcm_m.z();
  const double out_m = sideways ? robot.outer_width_m() / 2 - std::abs(robot.body.p_BBcm_m.y())
                                : robot.contact_length_m() / 2 + robot.body.p_BBcm_m.x();
  const double limit_rad = std::atan(out_m / up_m);
  const double found_rad = boundary(0.3 * limit_rad, 1.5 * limit_rad, [&](double angle_rad) {
    return sideways ? stays_upright(robot, 0, angle_rad) : stays_upright(robot, angle_rad, 0);
  });
  return {fmt::format("`{}`, slope on which it tips {}", name, sideways ? "sideways" : "backwards"),
          "atan(distance to the edge of the support / height of the centre of mass)", limit_rad * kDegrees,
          found_rad * kDegrees, "°"};
}

// The highest step that the front wheels climb: tests/physics/wheels_test.cpp has the derivation.
double highest_step_m(const RobotDescription& robot, double mu) {
  const double r = robot.track.front().end_radius_m, base = robot.contact_length_m();
  const double back = base / 2 + robot.body.p_BBcm_m.x();
  const auto climbs = [&](double h) {
    const double cos_a = (r - h) / r, sin_a = std::sqrt(1 - cos_a * cos_a), l = base + r * sin_a;
    const double rear = (l - back) / (l - mu * h), along = -mu * rear, up = 1 - rear;
    return along * cos_a + up * sin_a <= mu * (up * cos_a - along * sin_a);
  };
  double low = 0, high = r;
  for (int i = 0; i < 60; ++i) (climbs((low + high) / 2) ? low : high) = (low + high) / 2;
  return low;
}

bool lifts_its_front(const RobotDescription& robot, double step_m) {
  WorldDescription world;
  world.planes.push_back({{}, 1});
  world.boxes.push_back({"step", {2, 4, step_m}, {{1, 0, step_m / 2}, Eigen::Quaterniond::Identity()}, 1, 0});
  // the front wheels 10 mm before the edge; slowly, as momentum would carry it up
  const double front_m = robot.track.front().p_BT_m.x() + robot.track.front().end_radius_m;
  Climb climb(world, robot, {{-front_m - 0.01, 0, robot.ride_height_m()}, Eigen::Quaterniond::Identity()});
  climb.drive(0.01, 2 * robot.track.front().end_radius_m / 0.01);
  return -climb.rpy().y() > 0.6 * std::asin(step_m / robot.contact_length_m());
}

// Endless stairs of `rise_m` and `going_m`; the robot's belly on the noses.
bool climbs_stairs(const RobotDescription& robot, double rise_m, double going_m) {
  WorldDescription world;
  for (int k = -8; k < 16; ++k)
    world.boxes.push_back({fmt::format("step {}", k),
                           {going_m, 4, 4},
                           {{(k + 0.5) * going_m, 0, k * rise_m - 2}, Eigen::Quaterniond::Identity()},
                           1,
                           0});
  const double pitch_rad = std::atan(rise_m / going_m);
  const Pose X_WNoses{Eigen::Vector3d::Zero(), physics::rotation_from({0, -pitch_rad, 0})};
  Climb climb(world, robot, compose(X_WNoses, {{0, 0, robot.ride_height_m() + 0.002}, Eigen::Quaterniond::Identity()}));
  climb.drive(0, 0.5);
  const double settled_m = climb.moved_m();
  climb.drive(0.05, 8);
  return climb.moved_m() - settled_m > 0.2 * std::cos(pitch_rad);
}

}  // namespace

std::vector<ComparisonRow> slope_limits() {
  std::vector<ComparisonRow> rows;
  for (const char* name : {"kenaf", "husky"}) {
    for (const double mu : {0.4, 0.7}) {
      const RobotDescription robot = plain(name, mu);
      const double found_rad = boundary(0.1, 0.9, [&](double angle_rad) { return holds(robot, angle_rad); });
      rows.push_back({fmt::format("`{}`, steepest slope that holds it, friction {}", name, mu), "atan mu",
                      std::atan(mu) * kDegrees, found_rad * kDegrees, "°"});
    }
  }
  for (const char* name : {"p3at", "husky", "warthog"}) {
    rows.push_back(tipping(name, false));
    rows.push_back(tipping(name, true));
  }
  return rows;
}

std::vector<ComparisonRow> step_limits() {
  std::vector<ComparisonRow> rows;
  for (const char* name : {"husky", "jackal", "p2at"}) {
    for (const double mu : {0.3, 0.45}) {
      RobotDescription robot = plain(name, mu);
      robot.body.size_m.x() = 0.5 * robot.contact_length_m();  // the hull must not touch the step before the wheels
      const double limit_m = highest_step_m(robot, mu);
      const double found_m =
          boundary(0.5 * limit_m, 1.6 * limit_m, [&](double step_m) { return lifts_its_front(robot, step_m); });
      rows.push_back({fmt::format("`{}`, step that its front wheels climb, friction {}", name, mu),
                      "statics with all wheels driven", 1e3 * limit_m, 1e3 * found_m, "mm"});
    }
  }
  return rows;
}

std::vector<ComparisonRow> stair_limits() {
  std::vector<ComparisonRow> rows;
  struct Stairs {
    double rise_m, going_m;
  };
  for (const Stairs& stairs : {Stairs{0.06, 0.12}, {0.1, 0.15}}) {
    const double slope = stairs.rise_m / stairs.going_m;
    const double found = boundary(2 * slope, 0.4 * slope, [&](double mu) {
      RobotDescription robot = plain("kenaf", mu);
      robot.body.p_BBcm_m.z() = -0.08;  // low, so that friction and not balance decides
      return climbs_stairs(robot, stairs.rise_m, stairs.going_m);
    });
    rows.push_back({fmt::format("`kenaf` on its belts, friction to climb stairs of {:.0f} by {:.0f} mm",
                                1e3 * stairs.rise_m, 1e3 * stairs.going_m),
                    "tan of the stairs' slope (Endo and Nagatani 2016)", slope, found, ""});
  }
  return rows;
}

std::vector<SlipRow> slip_on_slopes() {
  constexpr double kFriction = 0.7, kSpeed_mps = 0.2;
  std::vector<SlipRow> rows;
  for (const double share : {0.3, 0.6, 0.9, 0.98}) {
    const double slope_rad = std::atan(share * kFriction);
    Climb climb = on_slope(plain("kenaf", kFriction), slope_rad, 0);
    climb.drive(kSpeed_mps, 2);
    const double before_m = climb.moved_m();
    climb.drive(kSpeed_mps, 2);
    rows.push_back({share, 1 - (climb.moved_m() - before_m) / std::cos(slope_rad) / (2 * kSpeed_mps)});
  }
  return rows;
}

}  // namespace kenaf::validation
