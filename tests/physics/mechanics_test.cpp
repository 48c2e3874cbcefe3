// Blocks and robots stand, stop and tip where rigid-body mechanics says. The references are closed forms: v^2 / (2 mu
// g) for the stopping distance, the angle at which the centre of mass stands above the edge for tipping, and the
// friction angle for holding. A robot on stopped belts slides as a block does, and neither belts without drive nor
// belts without friction move it.
#include <catch2/catch.hpp>

#include "tests/physics/scenes.hpp"

using namespace kenaf;
using namespace kenaf::physics;

namespace {

constexpr double kDegree = std::numbers::pi / 180;

// A slope through W's origin that falls away forward by `slope_rad`, and its frame P: x down the slope, z out of it.
Pose slope_frame(double slope_rad) {
  return {Eigen::Vector3d::Zero(), rotation_from({0, slope_rad, 0})};
}
Eigen::Vector3d on_slope(const Pose& X_WP, const Pose& X_WB) {
  return inverse(X_WP).q * X_WB.p;
}

// By how much a body leans out of the slope's normal.
double tilt_of(const Pose& X_WP, const Pose& X_WB) {
  return std::acos(std::clamp((X_WP.q * Eigen::Vector3d::UnitZ()).dot(X_WB.q * Eigen::Vector3d::UnitZ()), -1.0, 1.0));
}

// Kenaf without flippers and with its centre `height_m` above the ground.
RobotDescription tall_robot(double height_m) {
  RobotDescription robot = plain_tracks(2);
  const double ground_z = robot.track.front().p_BT_m.z() - robot.track.front().end_radius_m;
  robot.body.p_BBcm_m = {0, 0, ground_z + height_m};
  return robot;
}

// What is let go at its tipping angle falls by what its contacts give way, and needs no more than that to tip: 0.1 mm
// are sqrt(2 * 0.1 mm / 0.16 m) = 2 degrees. With contacts a thousand times as stiff that is 0.06 degrees.
constexpr PhysicsSettings kStiff{.contact_stiffness_npm = 2e8};

}  // namespace

// From v to standstill by friction alone: 0.4^2 / (2 * 0.1 * 9.80665) = 81.6 mm.
TEST_CASE("A robot whose belts stop at once slides for v^2 / (2 mu g)") {
  const double mu = 0.1, v = 0.4;
  RobotDescription robot = plain_tracks(mu);
  robot.drive.time_constant_s = 0;
  robot.drive.max_force_n = 1e5;
  for (const double yaw : {0.0, 0.7}) {
    World world(ground(), {}, 1);
    const RobotId id = world.add_robot(robot, "a", {Eigen::Vector3d::Zero(), rotation_from({0, 0, yaw})});
    world.set_command(id, drive(v, v));
    run(world, 1);  // v / (mu g) = 0.41 s to get there
    REQUIRE(world.truth(id).v_WB_mps.norm() == Approx(v).epsilon(1e-3));
    const Eigen::Vector3d start = world.truth(id).X_WB.p;
    world.set_command(id, drive(0, 0));
    run(world, 1);
    CHECK(world.truth(id).v_WB_mps.norm() < 1e-4);
    // the semi-implicit step stops v h / 2 = 0.2 mm short, which is 0.25 %; as much again for what rocks
    CHECK((world.truth(id).X_WB.p - start).norm() == Approx(v * v / (2 * mu * kGravity)).epsilon(0.005));
  }
}

// The centre is above the edge at atan(b / h) = atan(0.1 / 0.3) = 18.43 degrees. 0.2 degrees to either side: kStiff.
TEST_CASE("A block on a slope tips at the angle whose tangent is its width by its height") {
  const Eigen::Vector3d size(0.1, 0.2, 0.3);
  const double edge = std::atan(size.x() / size.z());
  for (const double off : {-0.2 * kDegree, 0.2 * kDegree}) {
    const Pose X_WP = slope_frame(edge + off);
    World world(ground(1, edge + off), kStiff, 1);
    const BoxId box =
        world.add_box(loose_box(size, compose(X_WP, {{0, 0, 0.15}, Eigen::Quaterniond::Identity()}), 2, 1));
    run(world, 2);
    const double tilt = tilt_of(X_WP, world.box_pose(box));
    INFO("slope " << (edge + off) / kDegree << " degrees: leans by " << tilt / kDegree);
    CHECK((off < 0 ? tilt < 0.1 * kDegree : tilt > 45 * kDegree));
  }
}

// 1 mm to either side: its edge gives way, and the block with it, by 0.1 mm.
TEST_CASE("A block that is pushed over an edge tips once its centre is beyond it") {
  for (const double beyond_m : {-1e-3, 1e-3}) {
    World world(ground(), {}, 1);
    world.add_box(fixed_box({1, 1, 1}, {-0.5, 0, 0.5}));
    const BoxId box =
        world.add_box(loose_box({0.3, 0.2, 0.1}, {{beyond_m, 0, 1.05}, Eigen::Quaterniond::Identity()}, 2, 1));
    run(world, 3);
    INFO(beyond_m);
    CHECK((world.box_pose(box).p.z() > 1) == (beyond_m < 0));
  }
}

// It tips over the end of its belly, (length / 2 - end radius) from its centre, or over a track's outer edge. 0.5
// degrees to either side: a robot is put down 0.01 mm above the ground, which is 0.4 degrees as in kStiff.
TEST_CASE("A robot on a slope tips over its belly's end, or over its track's edge, where its centre is above it") {
  const double height_m = 0.34;
  const RobotDescription robot = tall_robot(height_m);
  const double half_length = robot.track.front().length_m / 2 - robot.track.front().end_radius_m;
  const double half_width = robot.track.front().p_BT_m.y() + robot.track.front().width_m / 2;
  struct Case {
    double heading, reach_m;
  };
  for (const auto& [heading, reach_m] :
       {Case{0, half_length}, Case{std::numbers::pi, half_length}, Case{std::numbers::pi / 2, half_width},
        Case{-std::numbers::pi / 2, half_width}}) {
    const double edge = std::atan(reach_m / height_m);
    for (const double off : {-0.5 * kDegree, 0.5 * kDegree}) {
      const Pose X_WP = slope_frame(edge + off);
      World world(ground(1, edge + off), kStiff, 1);
      const RobotId id = world.add_robot(robot, "a", compose(X_WP, {{0, 0, 0.09}, rotation_from({0, 0, heading})}));
      run(world, 2);
      const double tilt = tilt_of(X_WP, world.truth(id).X_WB);
      INFO("heading " << heading << ", slope " << (edge + off) / kDegree << ": leans by " << tilt / kDegree);
      CHECK((off < 0 ? tilt < 0.1 * kDegree : tilt > 30 * kDegree));
    }
  }
}

// tan 30 = 0.5774; 1 % of it to either side. Held for 5 s: what creeps is not held.
TEST_CASE("Block and robot hold on a slope where mu is 1 % above its tangent, and slide where it is 1 % below",
          "[long]") {
  const double slope = 30 * kDegree;
  const Pose X_WP = slope_frame(slope);
  for (const double share : {1.01, 0.99}) {
    const double mu = share * std::tan(slope), acceleration = kGravity * (std::sin(slope) - mu * std::cos(slope));
    World world(ground(1, slope), {}, 1);
    const BoxId box =
        world.add_box(loose_box({0.3, 0.3, 0.1}, compose(X_WP, {{0, 2, 0.05}, Eigen::Quaterniond::Identity()}), 5, mu));
    std::vector<RobotId> robots;
    for (const double heading : {0.0, 0.6, std::numbers::pi / 2})
      robots.push_back(world.add_robot(
          plain_tracks(mu), "a",
          compose(X_WP, {{0, -2.0 * static_cast<double>(robots.size()), 0.09}, rotation_from({0, 0, heading})})));
    run(world, 0.5);
    std::vector<double> start{on_slope(X_WP, world.box_pose(box)).x()};
    for (const RobotId id : robots) start.push_back(on_slope(X_WP, world.truth(id).X_WB).x());
    run(world, 5);
    std::vector<double> moved{on_slope(X_WP, world.box_pose(box)).x() - start[0]};
    for (std::size_t i = 0; i < robots.size(); ++i)
      moved.push_back(on_slope(X_WP, world.truth(robots[i]).X_WB).x() - start[i + 1]);
    for (const double moved_m : moved) {
      INFO("mu " << mu << ": moved by " << moved_m << " m");
      if (share > 1)
        CHECK(std::abs(moved_m) < 1e-4);
      else  // 0.049 m/s^2 for 5 s, and what it had gathered before
        CHECK(moved_m > acceleration * 5 * 5 / 2 * 0.95);
    }
  }
}

TEST_CASE("With stopped belts a robot slides as a block of its mass and friction does, whichever way it points") {
  const double slope = 30 * kDegree, mu = 0.3;
  const Pose X_WP = slope_frame(slope);
  const RobotDescription robot = plain_tracks(mu);
  for (const double heading : {0.0, 0.6, std::numbers::pi / 2, std::numbers::pi}) {
    World world(ground(1, slope), {}, 1);
    const BoxId box = world.add_box(loose_box(
        {0.6, 0.4, 0.1}, compose(X_WP, {{0, 2, 0.05}, Eigen::Quaterniond::Identity()}), robot.total_mass_kg(), mu));
    const RobotId id = world.add_robot(robot, "a", compose(X_WP, {{0, -2, 0.09}, rotation_from({0, 0, heading})}));
    run(world, 0.2);  // both have come to lie on the slope
    const double box_start = on_slope(X_WP, world.box_pose(box)).x();
    const double robot_start = on_slope(X_WP, world.truth(id).X_WB).x();
    run(world, 1);
    const double box_m = on_slope(X_WP, world.box_pose(box)).x() - box_start;
    const double robot_m = on_slope(X_WP, world.truth(id).X_WB).x() - robot_start;
    INFO("heading " << heading << ": block " << box_m << " m, robot " << robot_m << " m");
    // they were let go at heights that differ by a few tens of micrometres, which is some ms of falling: 0.5 %
    CHECK(robot_m == Approx(box_m).epsilon(0.005));
  }
}

TEST_CASE("Belts whose motors give nothing move no robot") {
  RobotDescription robot = load_robot("kenaf");
  robot.drive.max_force_n = 1e-9;
  World world(ground(), {}, 1);
  const RobotId id = world.add_robot(robot, "a", {});
  run(world, 0.5);
  const Pose before = world.truth(id).X_WB;
  world.set_command(id, drive(0.4, 0.4));
  run(world, 5);
  // friction of 300 N holds against 2e-9 N; 0.1 mm is what it may creep
  CHECK((world.truth(id).X_WB.p - before.p).norm() < 1e-4);
  CHECK(std::abs(world.truth(id).track_mps[robot::kLeft]) < 1e-4);
}

TEST_CASE("It is friction that moves a robot: without it the belts run and the robot stays") {
  World world(ground(0), {}, 1);
  const RobotId id = world.add_robot(load_robot("kenaf"), "a", {});
  run(world, 0.5);
  const Pose before = world.truth(id).X_WB;
  world.set_command(id, drive(0.4, 0.4));
  run(world, 2);
  CHECK(world.truth(id).track_mps[robot::kLeft] == Approx(0.4).epsilon(1e-3));
  // the least friction coefficient is 1e-6: 1e-5 m/s^2 for 2 s are 0.02 mm
  CHECK((world.truth(id).X_WB.p - before.p).norm() < 1e-4);
}
