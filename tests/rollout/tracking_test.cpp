// What motion capture or lidar says of where the robot is: late, and with a scale of its own.
#include "rollout/tracking.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "rollout/roll_out.hpp"

using namespace kenaf;
using namespace kenaf::rollout;

namespace {

// Without noise; the two simulations that a test compares are the same to the last bit, and only their report differs.
runs::Run driven(const physics::Effects& effects, double left_mps, double right_mps, const Start& start) {
  physics::RobotDescription robot = physics::load_robot("kenaf");
  robot.effects = effects;
  physics::WorldDescription world;
  world.planes.push_back({});
  world.start_poses.push_back({"start", {}});
  Manoeuvre manoeuvre;
  manoeuvre.start = start;
  physics::RobotCommand command;
  command.track_speed_mps = {left_mps, right_mps};
  manoeuvre.timed = {{0, command}, {2, command}};
  RollOutOptions options;
  options.physics.time_step_s = 0.005;
  options.noise_scale = 0;
  return roll_out(robot, world, manoeuvre, options).run;
}

constexpr Start kSomewhere{.x_m = 5, .y_m = -2, .yaw_rad = 0, .z_m = {}, .flipper_rad = {}, .motion = {}};

bool same_bits(const runs::Run& a, const runs::Run& b, std::string_view column) {
  return std::ranges::equal(a.column(column), b.column(column),
                            [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); });
}

}  // namespace

TEST_CASE("Tracking that is 0.1 s late sees a robot at 0.3 m/s 30 mm behind where it is") {
  const runs::Run prompt = driven({}, 0.3, 0.3, kSomewhere);
  for (const double delay_s : {0.1, 0.105}) {  // 0.105 s lies half way between two rows
    const runs::Run late = driven({.tracking_delay_s = delay_s}, 0.3, 0.3, kSomewhere);
    const auto x = prompt.column("x_m"), late_x = late.column("x_m");
    // at a steady speed, which is 0.3 m/s to a part in a thousand after its lag of 0.05 s
    for (const std::size_t row : {100u, 150u, 200u}) CHECK(x[row] - late_x[row] == Approx(0.3 * delay_s).epsilon(2e-3));
    // before the first row it stood at the start
    CHECK(late_x[0] == x[0]);
    CHECK(late_x[5] == x[0]);
    CHECK(late_x[10] == x[0]);
    // also while it speeds up: exactly what was, in proportion between the rows
    const auto whole = static_cast<std::size_t>(delay_s / 0.01 + 1e-9);
    const double share = delay_s / 0.01 - static_cast<double>(whole);
    for (std::size_t row = whole + 1; row < x.size(); ++row)
      REQUIRE(late_x[row] == Approx((1 - share) * x[row - whole] + share * x[row - whole - 1]).epsilon(0).margin(1e-9));
  }
}

TEST_CASE("Late tracking concerns x, y, z and yaw, what the robot measures itself is in time") {
  const runs::Run prompt = driven({}, 0.1, 0.3, kSomewhere),
                  late = driven({.tracking_delay_s = 0.2}, 0.1, 0.3, kSomewhere);
  REQUIRE(prompt.columns == late.columns);
  for (const std::string& column : prompt.columns) {
    INFO(column);
    const bool tracked = column == "x_m" || column == "y_m" || column == "z_m" || column == "yaw_rad";
    if (!tracked) CHECK(same_bits(prompt, late, column));
    if (tracked)
      for (std::size_t row = 20; row < prompt.row_count(); ++row)
        REQUIRE(late.column(column)[row] == Approx(prompt.column(column)[row - 20]).epsilon(0).margin(1e-9));
  }
}

TEST_CASE("Yaw between two rows takes the short way across half a turn") {
  Tracking tracking({.tracking_delay_s = 0.005});
  const double just = 0.02;
  tracking.report(0, {Eigen::Vector3d::Zero(), std::numbers::pi - just});
  const TrackedPose middle = tracking.report(0.01, {Eigen::Vector3d::UnitX(), just - std::numbers::pi});
  CHECK(middle.p_WB_m.x() == Approx(0.5));
  CHECK(std::abs(middle.yaw_rad) == Approx(std::numbers::pi));
}

TEST_CASE("A scale of 0.9 shows 0.9 of the way from the first pose, wherever that is") {
  for (const double yaw_rad : {0.0, 0.7}) {
    Start start = kSomewhere;
    start.yaw_rad = yaw_rad;
    const runs::Run right = driven({}, 0.2, 0.3, start), wrong = driven({.tracking_scale = 0.9}, 0.2, 0.3, start);
    for (const char* column : {"x_m", "y_m"}) {
      const auto p = right.column(column), scaled = wrong.column(column);
      CHECK(scaled.front() == p.front());
      for (std::size_t row = 0; row < p.size(); ++row)
        REQUIRE(scaled[row] - p[0] == Approx(0.9 * (p[row] - p[0])).epsilon(0).margin(1e-12));
    }
    for (const std::string& column : right.columns)
      if (column != "x_m" && column != "y_m") CHECK(same_bits(right, wrong, column));
  }
}

TEST_CASE("Late and scaled: 0.9 of where it was") {
  Tracking tracking({.tracking_delay_s = 0.1, .tracking_scale = 0.9});
  const auto at = [](double x_m) { return TrackedPose{{x_m, 0, x_m}, 0}; };
  CHECK(tracking.report(0, at(2)).p_WB_m.x() == 2);
  CHECK(tracking.report(0.1, at(3)).p_WB_m.x() == 2);
  const TrackedPose reported = tracking.report(0.2, at(4));
  CHECK(reported.p_WB_m.x() == Approx(2 + 0.9 * (3 - 2)));
  CHECK(reported.p_WB_m.z() == Approx(3));
}
