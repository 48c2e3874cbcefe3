// Effects of the body stage: mass, moments of inertia, centre of mass.
#include <catch2/catch.hpp>

#include "tests/physics/scenes.hpp"

using namespace kenaf::physics;

namespace {

RobotDescription smooth_robot(const Effects& effects) {
  RobotDescription robot = plain_tracks(0);
  robot.body.friction = 0;
  robot.effects = effects;
  return robot;
}

// The moment of inertia about `axis` that a bump shows. A robot falls, without turning, onto one narrow obstacle that
// is `lever_m` beside its centre of mass. Whatever the contact's law, its impulse p gives M dv = p and I dw = lever p,
// so I = lever M dv / dw.
double moment_of_inertia(const Effects& effects, const Eigen::Vector3d& down, const Box& obstacle, Eigen::Index axis,
                         double lever_m) {
  WorldDescription description;
  description.gravity_W_mps2 = kGravity * down;
  description.boxes.push_back(obstacle);
  World world(description, {}, 1);
  const RobotDescription robot = smooth_robot(effects);
  const RobotId id = world.add_robot(robot, "a", {{0, 0, 0}, Eigen::Quaterniond::Identity()});
  // that holds at every moment of the bump; the first milliseconds are over before the lever changes
  for (int i = 0, touching = 0; i < 1000 && touching < 5; ++i) {
    world.step();
    touching += world.contact_count() > 0;
  }
  const RobotTruth truth = world.truth(id);
  const Eigen::Vector3d v_Wcm = truth.v_WB_mps + truth.w_WB_radps.cross(truth.X_WB.q * robot.body.p_BBcm_m);
  const double stopped_mps = kGravity * world.time_s() - v_Wcm.dot(down);
  return lever_m * robot.body.mass_kg * effects.mass_scale * stopped_mps / std::abs(truth.w_WB_radps[axis]);
}

}  // namespace

TEST_CASE("Mass: force = mass times acceleration") {
  for (const double scale : {0.5, 1.0, 2.0}) {
    RobotDescription robot = plain_tracks(1);
    robot.drive.max_force_n = 10;
    robot.drive.max_speed_mps = 100;  // the motor's line is flat here
    robot.drive.time_constant_s = 0;
    robot.battery.internal_resistance_ohm = 0;
    robot.effects.mass_scale = scale;
    World world(ground(), {}, 1);
    const RobotId id = world.add_robot(robot, "a", {});
    run(world, 0.5);
    world.set_command(id, drive(50, 50));
    run(world, 0.2);
    // 20 N move the body and both belts of 1.5 kg
    CHECK(world.truth(id).v_WB_mps.x() == Approx(20 / (15 * scale + 3) * 0.2).epsilon(0.01));
  }
}

TEST_CASE("Inertia: about each axis alone, and with the mass") {
  const Box bar_across = fixed_box({0.002, 1, 0.1}, {0.2, 0, -0.25});  // under the nose: pitch
  const Box bar_along = fixed_box({1, 0.002, 0.1}, {0, 0.1, -0.25});   // under the left track: roll
  const Box post = fixed_box({0.002, 0.1, 1}, {0.2, -0.3, 0});         // to the right of the nose: yaw
  const Eigen::Vector3d down(0, 0, -1), right(0, -1, 0);
  const auto roll = [&](const Effects& e) { return moment_of_inertia(e, down, bar_along, 0, 0.1); };
  const auto pitch = [&](const Effects& e) { return moment_of_inertia(e, down, bar_across, 1, 0.2); };
  const auto yaw = [&](const Effects& e) { return moment_of_inertia(e, right, post, 2, 0.2); };
  CHECK(roll({}) == Approx(0.13).epsilon(0.02));
  CHECK(pitch({}) == Approx(0.44).epsilon(0.02));
  CHECK(yaw({}) == Approx(0.52).epsilon(0.02));
  CHECK(roll({.roll_inertia_scale = 2}) == Approx(0.26).epsilon(0.02));
  CHECK(pitch({.pitch_inertia_scale = 2}) == Approx(0.88).epsilon(0.02));
  CHECK(yaw({.yaw_inertia_scale = 2}) == Approx(1.04).epsilon(0.02));
  CHECK(pitch({.roll_inertia_scale = 2, .yaw_inertia_scale = 2}) == Approx(0.44).epsilon(0.02));
  CHECK(pitch({.mass_scale = 2}) == Approx(0.88).epsilon(0.02));
}

TEST_CASE("Centre of mass ahead: a robot tips over an edge that its centre of mass has passed") {
  // a table whose edge is 50 mm ahead of the robot's centre
  const auto pitch_after = [](double com_forward_m) {
    WorldDescription description;
    description.boxes.push_back(fixed_box({2, 2, 0.5}, {-0.95, 0, -0.35}));
    World world(description, {}, 1);
    RobotDescription robot = plain_tracks(1);
    robot.effects.com_forward_m = com_forward_m;
    const RobotId id = world.add_robot(robot, "a", {});
    run(world, 0.9);
    return roll_pitch_yaw(world.truth(id).X_WB.q).y();
  };
  CHECK(std::abs(pitch_after(0.04)) < 0.02);
  CHECK(pitch_after(0.06) > 0.1);
}

TEST_CASE("Centre of mass up and left: a robot tips sideways where its weight leaves its tracks") {
  // Falling away to the left: it tips about the left track's outer edge, 0.145 m from the middle and 0.0317 m below the
  // centre of mass, at atan(0.145 / 0.0317) = 78 degrees. 0.1 m higher that is 47.7 degrees; 0.05 m further left too,
  // 35.8 degrees.
  const auto tips = [](double slope_deg, const Effects& effects) {
    const double a = slope_deg * std::numbers::pi / 180;
    WorldDescription description = ground();
    description.gravity_W_mps2 = kGravity * Eigen::Vector3d(0, std::sin(a), -std::cos(a));
    World world(description, {}, 1);
    RobotDescription robot = plain_tracks(8);
    robot.effects = effects;
    const RobotId id = world.add_robot(robot, "a", {});
    run(world, 1);
    return std::abs(roll_pitch_yaw(world.truth(id).X_WB.q).x()) > 0.2;
  };
  CHECK(!tips(55, {}));
  CHECK(!tips(45, {.com_up_m = 0.1}));
  CHECK(tips(50, {.com_up_m = 0.1}));
  CHECK(!tips(33, {.com_left_m = 0.05, .com_up_m = 0.1}));
  CHECK(tips(39, {.com_left_m = 0.05, .com_up_m = 0.1}));
  CHECK(!tips(50, {.com_left_m = -0.05, .com_up_m = 0.1}));
}
