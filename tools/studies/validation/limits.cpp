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

// At no time within 3 s more than 0.1 rad from the slope: a robot that rolls down is upright again for moments.
bool stays_upright(const RobotDescription& robot, double pitch_rad, double roll_rad) {
  Climb climb = on_slope(robot, pitch_rad, roll_rad);
  for (int i = 0; i < 60; ++i) {
    climb.drive(0, 0.05);
    if (std::abs(climb.rpy().x() - roll_rad) > 0.1 || std::abs(climb.rpy().y() + pitch_rad) > 0.1) return false;
  }
  return true;
}

ComparisonRow tipping(const char* name, bool sideways) {
  const RobotDescription robot = plain(name, 10);
  const double up_m = robot.ride_height_m() + robot.body.p_BBcm_m.z();
  const double out_m = sideways ? robot.outer_width_m() / 2 + robot.body.p_BBcm_m.y()  // to the right
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

struct Stairs {
  double rise_m, going_m;
};

// On endless stairs, the robot's belly on the noses.
Climb on_stairs(const RobotDescription& robot, const Stairs& stairs) {
  WorldDescription world;
  for (int k = -8; k < 16; ++k)
    world.boxes.push_back({fmt::format("step {}", k),
                           {stairs.going_m, 4, 4},
                           {{(k + 0.5) * stairs.going_m, 0, k * stairs.rise_m - 2}, Eigen::Quaterniond::Identity()},
                           1,
                           0});
  const Pose X_WNoses{Eigen::Vector3d::Zero(),
                      physics::rotation_from({0, -std::atan(stairs.rise_m / stairs.going_m), 0})};
  return {world, robot, compose(X_WNoses, {{0, 0, robot.ride_height_m() + 0.002}, Eigen::Quaterniond::Identity()})};
}

bool climbs_stairs(const RobotDescription& robot, const Stairs& stairs) {
  Climb climb = on_stairs(robot, stairs);
  climb.drive(0, 0.5);
  const double settled_m = climb.moved_m();
  climb.drive(0.05, 8);
  return climb.moved_m() - settled_m > 0.2 * stairs.going_m / std::hypot(stairs.rise_m, stairs.going_m);
}

constexpr double kRocked_rad = 0.02;

// As a nose leaves the rear end, the robot turns back about the next one, at the distance p ahead, until its rear arc
// meets the nose that it leaves. Turned by e, the arc of radius r is met up to x behind the straight run with
// r - sqrt(r² - x²) = e p, x = sqrt(2 r e p). The nose ahead is then p - x from the run's end, and the centre of mass,
// b from there and h above the run, lies over it at the slope a if b - (p - x) = h tan(a + e).
double height_that_rocks_m(const RobotDescription& robot, const Stairs& stairs) {
  const double b = robot.contact_length_m() / 2 + robot.body.p_BBcm_m.x() - robot.track.front().p_BT_m.x();
  const double p = std::hypot(stairs.rise_m, stairs.going_m), r = robot.track.front().end_radius_m;
  const double x = std::sqrt(2 * r * kRocked_rad * p);
  return (b - p + x) / std::tan(std::atan(stairs.rise_m / stairs.going_m) + kRocked_rad);
}

// Over three noses, slowly: whether the robot never pitches up by kRocked_rad.
bool keeps_its_pitch(const RobotDescription& robot, const Stairs& stairs) {
  constexpr double kSpeed_mps = 0.02, kLook_s = 0.05;
  Climb climb = on_stairs(robot, stairs);
  climb.drive(0, 0.5);
  const double pitch_rad = climb.rpy().y();
  const double time_s = 3 * std::hypot(stairs.rise_m, stairs.going_m) / kSpeed_mps;
  for (double t_s = 0; t_s < time_s; t_s += kLook_s) {
    climb.drive(kSpeed_mps, kLook_s);
    if (climb.rpy().y() < pitch_rad - kRocked_rad) return false;
  }
  return true;
}

// The slip at which belts pull `share` of all their friction, F = mu W [1 - K / (i L) (1 - exp(-i L / K))]: Wong,
// Theory of Ground Vehicles, 2.4, under an even load.
double slip_at_pull(double share, double length_m, double K_m) {
  const auto pull = [&](double slip) {
    const double shear = slip * length_m / K_m;
    return 1 + std::expm1(-shear) / shear;
  };
  double low = 1e-9, high = 1;
  for (int i = 0; i < 60; ++i) (pull((low + high) / 2) < share ? low : high) = (low + high) / 2;
  return low;
}

// The part of the belts' speed by which a robot that climbs a slope falls behind.
double slip_on_slope(const RobotDescription& robot, double slope_rad) {
  constexpr double kSpeed_mps = 0.2;
  Climb climb = on_slope(robot, slope_rad, 0);
  climb.drive(kSpeed_mps, 2);
  const double before_m = climb.moved_m();
  climb.drive(kSpeed_mps, 2);
  return 1 - (climb.moved_m() - before_m) / std::cos(slope_rad) / (2 * kSpeed_mps);
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
  for (const Stairs& stairs : {Stairs{0.06, 0.12}, {0.1, 0.15}}) {
    const double slope = stairs.rise_m / stairs.going_m;
    const double found = boundary(2 * slope, 0.4 * slope, [&](double mu) {
      RobotDescription robot = plain("kenaf", mu);
      robot.body.p_BBcm_m.z() = -0.08;  // low, so that friction and not balance decides
      return climbs_stairs(robot, stairs);
    });
    rows.push_back({fmt::format("`kenaf` on its belts, friction to climb stairs of {:.0f} by {:.0f} mm",
                                1e3 * stairs.rise_m, 1e3 * stairs.going_m),
                    "tan of the stairs' slope (Endo and Nagatani 2016)", slope, found, ""});
  }
  return rows;
}

std::vector<ComparisonRow> stair_balance() {
  std::vector<ComparisonRow> rows;
  for (const Stairs& stairs : {Stairs{0.06, 0.12}, {0.1, 0.15}}) {
    RobotDescription robot = plain("kenaf", 3);
    const double limit_m = height_that_rocks_m(robot, stairs);
    const double found_m = boundary(0.5 * limit_m, 1.5 * limit_m, [&](double height_m) {
      robot.body.p_BBcm_m.z() = height_m - robot.ride_height_m();
      return keeps_its_pitch(robot, stairs);
    });
    rows.push_back(
        {fmt::format("`kenaf` on its belts, height of the centre of mass at which it rocks back on stairs of "
                     "{:.0f} by {:.0f} mm",
                     1e3 * stairs.rise_m, 1e3 * stairs.going_m),
         "centre of mass above the foremost nose that it can turn about", 1e3 * limit_m, 1e3 * found_m, "mm"});
  }
  return rows;
}

std::vector<ComparisonRow> drawbar_pull() {
  constexpr double kFriction = 0.7;
  std::vector<ComparisonRow> rows;
  for (const double K_m : {0.005, 0.02, 0.05}) {
    for (const double share : {0.3, 0.6, 0.9}) {
      RobotDescription robot = plain("kenaf", kFriction);
      // At the ground's height, above the middle: the belts press evenly however much they pull.
      robot.body.p_BBcm_m = {robot.track.front().p_BT_m.x(), 0, -robot.ride_height_m()};
      robot.track.front().shear_deformation_m = K_m;
      const double expected = slip_at_pull(share, robot.contact_length_m(), K_m);
      if (expected > 0.95) continue;
      rows.push_back({fmt::format("`kenaf`, slip at a pull of {:.1f} of the limit, K {:.0f} mm", share, 1e3 * K_m),
                      "mu W [1 - K / (i L) (1 - exp(-i L / K))]", 100 * expected,
                      100 * slip_on_slope(robot, std::atan(share * kFriction)), "%"});
    }
  }
  return rows;
}

}  // namespace kenaf::validation
