// What motion capture or lidar says of where the robot is: late or early, with a scale, of another point, and turned.
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
  robot::Command command;
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

TEST_CASE("A point ahead of the body's centre goes round it as the robot turns, and starts where the run began") {
  // turned in place from 0.7 rad by a: the point is displaced by R(0.7 + a) L - R(0.7) L
  for (const Eigen::Vector2d& L : {Eigen::Vector2d(0.3, 0), Eigen::Vector2d(0, -0.2), Eigen::Vector2d(0.3, -0.2)}) {
    Tracking tracking({.tracked_point_forward_m = L.x(), .tracked_point_left_m = L.y()});
    const Eigen::Vector3d p(1, 2, 3);
    CHECK(tracking.report(0, {p, 0.7}).p_WB_m == p);
    for (const double a : {0.5, -2.0, std::numbers::pi}) {
      const TrackedPose reported = tracking.report(1, {p, 0.7 + a});
      const double b = 0.7 + a;
      CHECK(reported.p_WB_m.x() ==
            Approx(1 + L.x() * (std::cos(b) - std::cos(0.7)) - L.y() * (std::sin(b) - std::sin(0.7))));
      CHECK(reported.p_WB_m.y() ==
            Approx(2 + L.x() * (std::sin(b) - std::sin(0.7)) + L.y() * (std::cos(b) - std::cos(0.7))));
      CHECK(reported.p_WB_m.z() == 3);
      CHECK(reported.yaw_rad == b);
    }
  }
}

TEST_CASE("A heading that is reported too far left: the same yaw, and a path that is turned to the right") {
  Tracking tracking({.tracking_turn_rad = 0.2});
  tracking.report(0, {{1, 2, 3}, 0.7});
  // 2 m along the heading of 0.7 rad, then a turn: along 0.5 rad
  const TrackedPose ahead = tracking.report(1, {{1 + 2 * std::cos(0.7), 2 + 2 * std::sin(0.7), 3.5}, 1.5});
  CHECK(ahead.p_WB_m.x() == Approx(1 + 2 * std::cos(0.5)));
  CHECK(ahead.p_WB_m.y() == Approx(2 + 2 * std::sin(0.5)));
  CHECK(ahead.p_WB_m.z() == 3.5);
  CHECK(ahead.yaw_rad == 1.5);
}

TEST_CASE("With a turned tracker off the centre, the real run is recovered: one that drove where it headed") {
  // The body drives along its true heading of 0.3 rad for 2 m while it turns by 1 rad. The tracker, 0.4 m ahead of the
  // centre, says 0.2 rad more, and the simulation starts at what it says.
  const double true_rad = 0.3, turn_rad = 0.2, turned_rad = 1, forward_m = 0.4;
  const auto point = [&](double way_m, double heading_rad) {
    return Eigen::Vector2d(way_m * std::cos(true_rad) + forward_m * std::cos(heading_rad),
                           way_m * std::sin(true_rad) + forward_m * std::sin(heading_rad));
  };
  const Eigen::Vector2d start = point(0, true_rad), end = point(2, true_rad + turned_rad);
  const double reported_rad = true_rad + turn_rad;
  Tracking tracking({.tracked_point_forward_m = forward_m, .tracking_turn_rad = turn_rad});
  tracking.report(0, {{start.x(), start.y(), 0}, reported_rad});
  const TrackedPose simulated{{start.x() + 2 * std::cos(reported_rad), start.y() + 2 * std::sin(reported_rad), 0},
                              reported_rad + turned_rad};
  const TrackedPose reported = tracking.report(1, simulated);
  CHECK(reported.p_WB_m.x() == Approx(end.x()));
  CHECK(reported.p_WB_m.y() == Approx(end.y()));
  CHECK(reported.yaw_rad == Approx(reported_rad + turned_rad));
}

TEST_CASE("Values of another time: on the line between two of them, and beyond the ends the last one") {
  const std::vector<double> t_s{0, 1, 2, 4}, values{10, 20, 40, 0};
  CHECK(delayed(t_s, values, 0.5, false) == std::vector<double>{10, 15, 30, 10});
  CHECK(delayed(t_s, values, -0.5, false) == std::vector<double>{15, 30, 30, 0});
  CHECK(delayed(t_s, values, -1, false) == std::vector<double>{20, 40, 20, 0});
  CHECK(delayed(t_s, values, 9, false) == std::vector<double>(4, 10));
  CHECK(delayed(t_s, values, -9, false) == std::vector<double>(4, 0));
  const double just = 0.02, pi = std::numbers::pi;
  const std::vector<double> two{0, 1}, across{pi - just, 3 * just - pi};
  CHECK(delayed(two, across, 0.5, true)[1] == Approx(pi + just));  // the short way of 4 just
}

TEST_CASE("A clock that is behind is a delay, one that is ahead shows what comes, until the run ends") {
  const runs::Run prompt = driven({}, 0.1, 0.3, kSomewhere),
                  late_run = driven({.tracking_delay_s = 0.105}, 0.1, 0.3, kSomewhere),
                  behind = driven({.clock_offset_s = 0.105}, 0.1, 0.3, kSomewhere),
                  ahead = driven({.clock_offset_s = -0.2}, 0.1, 0.3, kSomewhere);
  const std::size_t rows = prompt.row_count();
  for (const std::string& column : prompt.columns) {
    INFO(column);
    const auto p = prompt.column(column), d = late_run.column(column), b = behind.column(column),
               a = ahead.column(column);
    if (column != "x_m" && column != "y_m" && column != "z_m" && column != "yaw_rad") {
      CHECK(same_bits(prompt, behind, column));
      CHECK(same_bits(prompt, ahead, column));
      continue;
    }
    for (std::size_t row = 0; row < rows; ++row) {
      REQUIRE(b[row] == Approx(d[row]).epsilon(0).margin(1e-9));
      REQUIRE(a[row] == Approx(p[std::min(row + 20, rows - 1)]).epsilon(0).margin(1e-9));
    }
  }
}

TEST_CASE("A clock that is off leaves the noise of each row as it was") {
  const auto standing = [](double offset_s) {
    physics::RobotDescription robot = physics::load_robot("kenaf");
    robot.effects.clock_offset_s = offset_s;
    physics::WorldDescription world;
    world.planes.push_back({});
    world.start_poses.push_back({"start", {}});
    Manoeuvre manoeuvre;
    manoeuvre.timed = {{0, {}}, {1, {}}};
    return roll_out(robot, world, manoeuvre, {}).run;
  };
  const runs::Run right = standing(0), off = standing(-0.1);
  // it does not move, so that noise is all that there is: a millimetre, of which an average of rows would have less
  for (std::size_t row = 0; row < right.row_count(); ++row)
    REQUIRE(off.column("y_m")[row] == Approx(right.column("y_m")[row]).epsilon(0).margin(1e-5));
}
