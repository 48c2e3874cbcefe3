// What motion capture or lidar says of where the robot is: late or early, with a scale, of another point, and turned.
#include "rollout/tracking.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "rollout/roll_out.hpp"

using namespace kenaf;
using namespace kenaf::rollout;

namespace {

// Without noise; the two simulations that a test compares are the same to the last bit, and only their report differs.
runs::Run driven(const physics::Effects& effects, double left_mps, double right_mps, const Start& start,
                 double for_s = 2) {
  physics::RobotDescription robot = physics::load_robot("kenaf");
  robot.effects = effects;
  physics::WorldDescription world;
  world.planes.push_back({});
  world.start_poses.push_back({"start", {}});
  Manoeuvre manoeuvre;
  manoeuvre.start = start;
  robot::Command command;
  command.track_speed_mps = {left_mps, right_mps};
  manoeuvre.timed = {{0, command}, {for_s, command}};
  RollOutOptions options;
  options.physics.time_step_s = 0.005;
  options.noise_scale = 0;
  return roll_out(robot, world, manoeuvre, options).run;
}

constexpr Start kSomewhere{.x_m = 5, .y_m = -2, .yaw_rad = 0, .z_m = {}, .flipper_rad = {}, .motion = {}};

// What is reported at 1 s of a robot that started at `start` at 0 s.
TrackedPose reported_of(const physics::Effects& effects, const TrackedPose& start, const TrackedPose& pose) {
  return reported_poses({{0, 1}, {start, pose}}, std::vector<double>{0, 1}, effects, {}).back();
}

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
  const double just = 0.02;
  const PoseCourse course{
      {0, 0.01},
      {{Eigen::Vector3d::Zero(), std::numbers::pi - just}, {Eigen::Vector3d::UnitX(), just - std::numbers::pi}}};
  const TrackedPose middle = course.at(0.005);
  CHECK(middle.p_WB_m.x() == Approx(0.5));
  CHECK(middle.yaw_rad == Approx(std::numbers::pi));
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
  const auto at = [](double x_m) { return TrackedPose{{x_m, 0, x_m}, 0}; };
  const PoseCourse course{{0, 0.1, 0.2}, {at(2), at(3), at(4)}};
  const std::vector<TrackedPose> reported =
      reported_poses(course, course.t_s, {.tracking_delay_s = 0.1, .tracking_scale = 0.9}, {});
  CHECK(reported[0].p_WB_m.x() == 2);
  CHECK(reported[1].p_WB_m.x() == 2);
  CHECK(reported[2].p_WB_m.x() == Approx(2 + 0.9 * (3 - 2)));
  CHECK(reported[2].p_WB_m.z() == Approx(3));
}

TEST_CASE("Before the first pose the robot moved as it did then, after the last one it stands") {
  const PoseCourse course{{1, 2}, {{{5, 0, 1}, 0.5}, {{6, 0, 1}, 0.7}}, {0.4, 0.2, 0}, -0.1};
  CHECK(course.at(1).p_WB_m == Eigen::Vector3d(5, 0, 1));
  // half a second earlier: 0.2 m and 0.1 m less, and 0.05 rad more
  CHECK(course.at(0.5).p_WB_m.isApprox(Eigen::Vector3d(4.8, -0.1, 1)));
  CHECK(course.at(0.5).yaw_rad == Approx(0.55));
  CHECK(course.at(9).p_WB_m == Eigen::Vector3d(6, 0, 1));
  CHECK(course.at(9).yaw_rad == 0.7);
}

TEST_CASE("A replay starts where the robot was first reported, however late or early that report was") {
  // Along a quarter of a circle of 2 m at 0.5 rad/s, from (0, 0) and a heading of 0. Its true first place was another
  // one; as reported it starts at the first pose, and drives the circle on from there.
  const double radius_m = 2, rate_radps = 0.5;
  const auto on_circle = [&](double turned_rad) {
    return TrackedPose{{radius_m * std::sin(turned_rad), radius_m * (1 - std::cos(turned_rad)), 0}, turned_rad};
  };
  PoseCourse course;
  for (int i = 0; i <= 4000; ++i) {
    course.t_s.push_back(i * 1e-3);
    course.pose.push_back(on_circle(rate_radps * course.t_s.back()));
  }
  course.v_WB_mps = {radius_m * rate_radps, 0, 0};
  course.yaw_radps = rate_radps;
  const std::vector<double> rows{0, 1, 2};

  for (const double offset_s : {-0.5, 0.01}) {
    INFO(offset_s);
    const physics::Effects effects{.clock_offset_s = offset_s};
    const std::vector<TrackedPose> replayed = reported_poses(course, rows, effects, on_circle(0)),
                                   in_world = reported_poses(course, rows, effects, {});
    for (std::size_t row = 0; row < rows.size(); ++row) {
      // a circle looks the same from each of its points
      const TrackedPose same = on_circle(rate_radps * rows[row]),
                        shifted = on_circle(rate_radps * (rows[row] - offset_s));
      CHECK((replayed[row].p_WB_m - same.p_WB_m).norm() < 1e-4);
      CHECK(replayed[row].yaw_rad == Approx(same.yaw_rad).margin(1e-9));
      CHECK((in_world[row].p_WB_m - shifted.p_WB_m).norm() < 1e-4);
      CHECK(in_world[row].yaw_rad == Approx(shifted.yaw_rad).margin(1e-9));
    }
  }
}

TEST_CASE("A point ahead of the body's centre goes round it as the robot turns, and starts where the run began") {
  // turned in place from 0.7 rad by a: the point is displaced by R(0.7 + a) L - R(0.7) L
  for (const Eigen::Vector2d& L : {Eigen::Vector2d(0.3, 0), Eigen::Vector2d(0, -0.2), Eigen::Vector2d(0.3, -0.2)}) {
    const physics::Effects effects{.tracked_point_forward_m = L.x(), .tracked_point_left_m = L.y()};
    const Eigen::Vector3d p(1, 2, 3);
    CHECK(reported_of(effects, {p, 0.7}, {p, 0.7}).p_WB_m == p);
    for (const double a : {0.5, -2.0, std::numbers::pi}) {
      const TrackedPose reported = reported_of(effects, {p, 0.7}, {p, 0.7 + a});
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
  // 2 m along the heading of 0.7 rad, then a turn: along 0.5 rad
  const TrackedPose ahead = reported_of({.tracking_turn_rad = 0.2}, {{1, 2, 3}, 0.7},
                                        {{1 + 2 * std::cos(0.7), 2 + 2 * std::sin(0.7), 3.5}, 1.5});
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
  const TrackedPose simulated{{start.x() + 2 * std::cos(reported_rad), start.y() + 2 * std::sin(reported_rad), 0},
                              reported_rad + turned_rad};
  const TrackedPose reported = reported_of({.tracked_point_forward_m = forward_m, .tracking_turn_rad = turn_rad},
                                           {{start.x(), start.y(), 0}, reported_rad}, simulated);
  CHECK(reported.p_WB_m.x() == Approx(end.x()));
  CHECK(reported.p_WB_m.y() == Approx(end.y()));
  CHECK(reported.yaw_rad == Approx(reported_rad + turned_rad));
}

TEST_CASE("A clock that is behind is a delay, one that is ahead shows what comes, also after the run") {
  const runs::Run prompt = driven({}, 0.1, 0.3, kSomewhere), longer = driven({}, 0.1, 0.3, kSomewhere, 2.2),
                  late_run = driven({.tracking_delay_s = 0.105}, 0.1, 0.3, kSomewhere),
                  behind = driven({.clock_offset_s = 0.105}, 0.1, 0.3, kSomewhere),
                  ahead = driven({.clock_offset_s = -0.2}, 0.1, 0.3, kSomewhere);
  const std::size_t rows = prompt.row_count();
  for (const std::string& column : prompt.columns) {
    INFO(column);
    CHECK(same_bits(late_run, behind, column));
    if (column == "x_m" || column == "y_m" || column == "z_m" || column == "yaw_rad") continue;
    CHECK(same_bits(prompt, behind, column));
    CHECK(same_bits(prompt, ahead, column));
  }

  // Seen from where it is 0.2 s after the start, which is where a replay puts it: the way from there on, turned back by
  // what it turned until then.
  REQUIRE(longer.row_count() == rows + 20);
  const auto place = [](const runs::Run& run, std::size_t row) {
    return Eigen::Vector2d(run.column("x_m")[row], run.column("y_m")[row]);
  };
  const auto yaw = [](const runs::Run& run, std::size_t row) { return run.column("yaw_rad")[row]; };
  const double turned_rad = yaw(longer, 20) - kSomewhere.yaw_rad;
  CHECK(turned_rad > 0.01);
  const Eigen::Rotation2Dd back(-turned_rad);
  for (std::size_t row = 0; row < rows; ++row) {
    const Eigen::Vector2d expected =
        Eigen::Vector2d(kSomewhere.x_m, kSomewhere.y_m) + back * (place(longer, row + 20) - place(longer, 20));
    REQUIRE((place(ahead, row) - expected).norm() < 1e-9);
    REQUIRE(yaw(ahead, row) == Approx(yaw(longer, row + 20) - turned_rad).epsilon(0).margin(1e-9));
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

TEST_CASE("A replay with the clock's offset meets an obstacle when the recorded robot did") {
  // Over a step of 100 mm, 0.4 m ahead of the belts, while the pose is reported 0.3 s early: at 0.3 m/s the first
  // reported pose is nearly 90 mm ahead of the start.
  physics::RobotDescription robot = physics::load_robot("kenaf");
  robot.effects.clock_offset_s = -0.3;
  std::vector<std::string> warnings;
  const physics::WorldDescription world = physics::load_world("step-100", warnings);
  Manoeuvre manoeuvre;
  robot::Command command;
  command.track_speed_mps = {0.3, 0.3};
  manoeuvre.timed = {{0, command}, {4, command}};
  RollOutOptions options;
  options.noise_scale = 0;
  const runs::Run recorded = roll_out(robot, world, manoeuvre, options).run;
  const auto pitch = recorded.column("pitch_rad");
  CHECK(*std::ranges::min_element(pitch) < -0.1);  // it climbs

  const runs::Run replayed = roll_out(robot, world, replay_of(recorded, "recorded"), options).run;
  REQUIRE(replayed.row_count() == recorded.row_count());
  const auto largest = [&](const char* column) {
    double difference = 0;
    for (std::size_t row = 0; row < recorded.row_count(); ++row)
      if (const double a = recorded.column(column)[row], b = replayed.column(column)[row]; !std::isnan(a + b))
        difference = std::max(difference, std::abs(a - b));
    return difference;
  };
  // 1 mm is 3 ms of its way; put down where it was reported first it would climb 0.3 s, some 0.2 rad, too early
  CHECK(largest("x_m") < 2e-3);
  CHECK(largest("pitch_rad") < 0.02);
  robot.effects.clock_offset_s = 0;
  const runs::Run too_early = roll_out(robot, world, replay_of(recorded, "recorded"), options).run;
  const auto early = too_early.column("pitch_rad");
  double difference = 0;
  for (std::size_t row = 0; row < early.size(); ++row)
    if (!std::isnan(early[row] + pitch[row])) difference = std::max(difference, std::abs(early[row] - pitch[row]));
  CHECK(difference > 0.1);
}
