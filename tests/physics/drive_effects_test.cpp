// Effects of the drive stage, and the battery that limits the drives.
#include <catch2/catch.hpp>

#include "tests/physics/scenes.hpp"

using namespace kenaf;
using namespace kenaf::physics;

namespace {

RobotDescription kenaf_with(const Effects& effects) {
  RobotDescription robot = load_robot("kenaf");
  robot.effects = effects;
  return robot;
}

// Drives for `time_s` on level ground.
RobotTruth driven(const RobotDescription& robot, double mps, double time_s) {
  World world(ground(), {}, 1);
  const RobotId id = world.add_robot(robot, "a", {});
  world.set_command(id, drive(mps, mps));
  run(world, time_s);
  return world.truth(id);
}

// Up (+) or down a slope without rolling over: a world whose gravity is turned.
World slope(double down_ahead_rad) {
  WorldDescription description = ground();
  description.gravity_W_mps2 = kGravity * Eigen::Vector3d(std::sin(down_ahead_rad), 0, -std::cos(down_ahead_rad));
  return World(description, {}, 1);
}

// Kenaf whose arms have their centre of mass half way out: two drums of one size.
RobotDescription even_arms(const Effects& effects) {
  RobotDescription robot = kenaf_with(effects);
  robot.flipper.front().pivot_radius_m = robot.flipper.front().tip_radius_m;
  return robot;
}

}  // namespace

TEST_CASE("Drive lag: two lags in a row") {
  const RobotTruth truth = driven(kenaf_with({.drive_lag_s = 0.2}), 0.3, 0.4);
  // lags of a and b answer a step with 1 - (a exp(-t/a) - b exp(-t/b)) / (a - b)
  const double a = 0.2, b = 0.05, t = 0.4;
  CHECK(truth.track_mps[robot::kLeft] ==
        Approx(0.3 * (1 - (a * std::exp(-t / a) - b * std::exp(-t / b)) / (a - b))).epsilon(0.01));
}

TEST_CASE("Drive asymmetry: half of it on each side") {
  const RobotTruth truth = driven(kenaf_with({.drive_asymmetry = 0.1}), 0.2, 1);
  CHECK(truth.track_mps[robot::kLeft] == Approx(0.21).epsilon(2e-3));
  CHECK(truth.track_mps[robot::kRight] == Approx(0.19).epsilon(2e-3));
  CHECK(truth.w_WB_radps.z() < 0);  // to the right
}

TEST_CASE("Drive torque limit: up a slope as fast as what is left of the motors' line allows") {
  // 15 kg on 20 degrees: 25.15 N for each track. Of 0.1 x 300 N at standstill, falling to none at 0.5 m/s, so much is
  // left at 0.0808 m/s.
  World world = slope(-20 * std::numbers::pi / 180);
  RobotDescription robot = plain_tracks(1.3);
  robot.effects.drive_torque_scale = 0.1;
  robot.battery.internal_resistance_ohm = 0;
  const RobotId id = world.add_robot(robot, "a", {});
  world.set_command(id, drive(0.3, 0.3));
  run(world, 3);
  const double needed_n = 15 * kGravity * std::sin(20 * std::numbers::pi / 180) / 2;
  CHECK(world.truth(id).track_mps[robot::kLeft] == Approx(0.5 * (1 - needed_n / 30)).epsilon(0.01));
}

TEST_CASE("Droop: a track is slower by droop times the force that it needs, and a brake lets it run as much faster") {
  for (const double step_s : {0.001, 0.005}) {
    // dry friction of 25 N and damping of 100 N s/m: u = 0.2 - d (25 + 100 u)
    const double d = 0.002;
    World level(ground(), {.time_step_s = step_s}, 1);
    const RobotId id = level.add_robot(
        kenaf_with({.drive_droop_mpspn = d, .drive_coulomb_n = 25, .drive_viscous_nspm = 100}), "a", {});
    level.set_command(id, drive(0.2, 0.2));
    run(level, 1);
    const double u = (0.2 - d * 25) / (1 + d * 100);
    CHECK(level.truth(id).track_mps[robot::kLeft] == Approx(u).epsilon(1e-3));
    CHECK(level.truth(id).track_force_n[robot::kLeft] == Approx(25 + 100 * u).epsilon(0.01));
  }
  // 15 kg down 10 degrees: 12.8 N for each track, held back
  World down = slope(10 * std::numbers::pi / 180);
  RobotDescription robot = plain_tracks(1.3);
  robot.effects.drive_droop_mpspn = 0.005;
  const RobotId id = down.add_robot(robot, "a", {});
  down.set_command(id, drive(0.2, 0.2));
  run(down, 2);
  const double brake_n = 15 * kGravity * std::sin(10 * std::numbers::pi / 180) / 2;
  CHECK(down.truth(id).track_mps[robot::kLeft] == Approx(0.2 + 0.005 * brake_n).epsilon(2e-3));
}

TEST_CASE("Droop: a motor at the end of its force gives no more than that") {
  RobotDescription robot = kenaf_with({.drive_droop_mpspn = 0.001, .drive_coulomb_n = 25});
  robot.drive.max_force_n = 20;
  const RobotTruth truth = driven(robot, 0.2, 1);  // 0.2 / 0.001 would be 200 N
  CHECK(std::abs(truth.track_m[robot::kLeft]) < 1e-6);
  CHECK(truth.track_force_n[robot::kLeft] == Approx(20).epsilon(0.01));
}

TEST_CASE("Coulomb friction: below it the belt stands still, above it the motor has that much less") {
  RobotDescription robot = kenaf_with({.drive_coulomb_n = 25});
  robot.battery.internal_resistance_ohm = 0;
  robot.drive.max_force_n = 20;
  const RobotTruth stalled = driven(robot, 0.2, 1);
  CHECK(std::abs(stalled.track_m[robot::kLeft]) < 1e-6);
  CHECK(stalled.track_force_n[robot::kLeft] == Approx(20).epsilon(1e-3));
  robot.drive.max_force_n = 300;
  const RobotTruth running = driven(robot, 0.2, 1);
  CHECK(running.track_mps[robot::kLeft] == Approx(0.2).epsilon(1e-3));
  CHECK(running.track_force_n[robot::kLeft] == Approx(25).epsilon(0.01));
}

TEST_CASE("Coulomb friction of one side: its motor has to give it beside that of both, the other one has not") {
  for (const bool of_left : {true, false}) {
    Effects effects{.drive_coulomb_n = 10};
    (of_left ? effects.drive_coulomb_left_n : effects.drive_coulomb_right_n) = 15;
    WorldDescription empty;
    empty.gravity_W_mps2.setZero();
    World world(empty, {}, 1);
    RobotDescription robot = plain_tracks(1);
    robot.effects = effects;
    const RobotId id = world.add_robot(robot, "a", {});
    world.set_command(id, drive(0.2, 0.2));
    run(world, 1);
    CHECK(world.truth(id).track_force_n[of_left ? robot::kLeft : robot::kRight] == Approx(25).epsilon(0.01));
    CHECK(world.truth(id).track_force_n[of_left ? robot::kRight : robot::kLeft] == Approx(10).epsilon(0.01));
  }
}

TEST_CASE("Coulomb friction: holds a robot on a slope whose motors are too weak to") {
  // 15 kg on 10 degrees: 12.8 N for each track; 6 N from the motor
  const auto rolled_m = [](double coulomb_n) {
    World world = slope(10 * std::numbers::pi / 180);
    RobotDescription robot = plain_tracks(1.3);
    robot.effects = {.drive_torque_scale = 0.02, .drive_coulomb_n = coulomb_n};
    const RobotId id = world.add_robot(robot, "a", {});
    run(world, 1);
    return world.truth(id).X_WB.p.x();
  };
  CHECK(rolled_m(8) < 1e-3);
  CHECK(rolled_m(5) > 0.05);
}

TEST_CASE("Viscous friction: force = damping times speed") {
  const RobotTruth truth = driven(kenaf_with({.drive_viscous_nspm = 100}), 0.2, 1);
  CHECK(truth.track_mps[robot::kLeft] == Approx(0.2).epsilon(1e-3));
  CHECK(truth.track_force_n[robot::kLeft] == Approx(20).epsilon(0.01));
}

TEST_CASE("Friction of the running gear: in the air as on the ground, and at 5 ms as at 1 ms") {
  for (const double step_s : {0.001, 0.005}) {
    WorldDescription empty;
    empty.gravity_W_mps2.setZero();
    World world(empty, {.time_step_s = step_s}, 1);
    RobotDescription robot = plain_tracks(1);
    robot.effects = {.drive_coulomb_n = 25, .drive_viscous_nspm = 100};
    const RobotId id = world.add_robot(robot, "a", {});
    world.set_command(id, drive(0.2, 0.2));
    run(world, 1);
    CHECK(world.truth(id).track_mps[robot::kLeft] == Approx(0.2).epsilon(1e-3));
    CHECK(world.truth(id).track_force_n[robot::kLeft] == Approx(45).epsilon(0.01));
  }
}

TEST_CASE("Battery: two stalled motors and the battery's resistance share the voltage") {
  for (const double added_ohm : {0.0, 2.0, 5.0}) {
    RobotDescription robot = plain_tracks(1);
    robot.drive.max_force_n = 80;
    robot.drive.amperes_per_newton = 0.15;  // 12 A at standstill
    robot.effects = {.drive_coulomb_n = 100, .battery_resistance_ohm = added_ohm};
    const RobotTruth truth = driven(robot, 0.3, 0.5);
    // each motor is a resistance of 25.9 V / 12 A
    const double motors_ohm = 25.9 / 12 / 2, voltage = 25.9 * motors_ohm / (motors_ohm + 0.1 + added_ohm);
    CHECK(truth.battery_v == Approx(voltage).epsilon(1e-6));
    CHECK(truth.track_force_n[robot::kLeft] == Approx(80 * voltage / 25.9).epsilon(1e-6));
  }
}

TEST_CASE("Battery: a sagging battery lowers the speed without load too") {
  // Alone against its own viscous friction d u, at the limit: 30 (s - u / 0.5) = 100 u, with s = V / 25.9 and
  // V = 25.9 - R 2 (0.4 A/N 100 u). All the voltage is on, so the battery gives what the motors take.
  RobotDescription robot = plain_tracks(1);
  robot.drive.max_force_n = 30;
  robot.drive.amperes_per_newton = 0.4;
  robot.drive.idle_amperes = 0;
  robot.effects = {.drive_viscous_nspm = 100, .battery_resistance_ohm = 0.9};
  const RobotTruth truth = driven(robot, 0.5, 3);
  const double u = 30 / (100 + 30 / 0.5 + 30 * 2 * 0.4 * 100 / 25.9);
  CHECK(truth.track_mps[robot::kLeft] == Approx(u).epsilon(2e-3));
  CHECK(truth.battery_v == Approx(25.9 - 2 * 0.4 * 100 * u).epsilon(2e-3));
}

TEST_CASE("Battery: motors that brake a robot downhill neither charge nor drain it") {
  World world = slope(15 * std::numbers::pi / 180);
  RobotDescription robot = plain_tracks(1.3);
  robot.drive.idle_amperes = 0;
  robot.effects.battery_resistance_ohm = 5;
  const RobotId id = world.add_robot(robot, "a", {});
  world.set_command(id, drive(0.2, 0.2));
  run(world, 1);
  CHECK(world.truth(id).track_mps[robot::kLeft] == Approx(0.2).epsilon(1e-3));
  // 15 kg on 15 degrees: 19 N for each, 6 % of the voltage; the turning makes 40 % of it the other way
  const auto [left_n, right_n] = world.truth(id).track_force_n;
  CHECK(left_n + right_n == Approx(-15 * kGravity * std::sin(15 * std::numbers::pi / 180)).epsilon(0.02));
  CHECK(world.truth(id).battery_v == Approx(25.9).epsilon(1e-9));
}

TEST_CASE("Flipper lag: the arm follows an angle that comes up to the command") {
  World world(ground(), {}, 1);
  const RobotId id = world.add_robot(kenaf_with({.flipper_lag_s = 1}), "a", {});
  world.set_command(id, drive(0, 0, 1.3, 1.3));
  run(world, 0.5);
  // the lag of 1 s and the position loop's of 1/30 s
  const double a = 1, b = 1.0 / 30, t = 0.5;
  CHECK(world.truth(id).flipper_rad[robot::kRearLeft] ==
        Approx(1 + 0.3 * (1 - (a * std::exp(-t / a) - b * std::exp(-t / b)) / (a - b))).margin(2e-3));
}

TEST_CASE("Flipper backlash: the arm hangs at the end of its play, on the side to which it is heavy") {
  for (const double step_s : {0.001, 0.005}) {
    World world(ground(), {.time_step_s = step_s}, 1);
    const RobotId id = world.add_robot(even_arms({.flipper_backlash_rad = 0.2}), "a", {});
    // ahead of the upright it hangs forward, behind it backward
    world.set_command(id, drive(0, 0, 0.4, 2.6));
    run(world, 3);
    const RobotTruth truth = world.truth(id);
    CHECK(truth.flipper_rad[robot::kFrontLeft] == Approx(0.3).margin(1e-3));
    CHECK(truth.flipper_rad[robot::kRearLeft] == Approx(2.7).margin(1e-3));
    CHECK(truth.servo_rad[robot::kFrontLeft] == Approx(0.4).margin(1e-3));
    CHECK(truth.servo_rad[robot::kRearLeft] == Approx(2.6).margin(1e-3));
    CHECK(std::abs(truth.flipper_radps[robot::kFrontLeft]) < 1e-3);
  }
}

TEST_CASE("Who lifts a robot turns no servo: with play the arms stay as far from theirs as they were") {
  World world(ground(), {}, 1);
  const RobotId id = world.add_robot(even_arms({.flipper_backlash_rad = 0.2}), "a", {});
  world.set_command(id, drive(0, 0, 0.4, 2.6));
  run(world, 3);
  world.teleport(id, {{0, 0, 0.3}, Eigen::Quaterniond::Identity()});
  const RobotTruth lifted = world.truth(id);
  CHECK(lifted.flipper_rad[robot::kFrontLeft] == Approx(0.3).margin(1e-3));  // half of the play below its servo
  CHECK(lifted.servo_rad[robot::kFrontLeft] == Approx(0.4).margin(1e-3));
  CHECK(lifted.flipper_radps[robot::kFrontLeft] == 0);
}

TEST_CASE("Flipper compliance: the arm gives way by torque times compliance") {
  for (const double step_s : {0.001, 0.005}) {
    World world(ground(), {.time_step_s = step_s}, 1);
    const double compliance = 0.05;
    const RobotDescription robot = even_arms({.flipper_compliance_radpnm = compliance});
    const RobotId id = world.add_robot(robot, "a", {});
    world.set_command(id, drive(0, 0, 0.4, 2.6));
    run(world, 3);
    const RobotTruth truth = world.truth(id);
    for (const auto& [flipper, wanted] : {std::pair{robot::kFrontLeft, 0.4}, {robot::kRearRight, 2.6}}) {
      const double arm = truth.flipper_rad[flipper];
      const double weight_nm = 1.25 * kGravity * 0.145 / 2 * std::cos(arm);
      CHECK(truth.flipper_nm[flipper] == Approx(weight_nm).epsilon(0.01));
      CHECK(wanted - arm == Approx(compliance * weight_nm).epsilon(0.01));
      CHECK(truth.servo_rad[flipper] == Approx(wanted).margin(1e-4));
      CHECK(std::abs(truth.flipper_radps[flipper]) < 1e-3);
    }
  }
}

TEST_CASE("Flipper compliance: a servo that is too weak gives way itself") {
  for (const double step_s : {0.001, 0.005}) {
    World world(ground(), {.time_step_s = step_s}, 1);
    const RobotId id =
        world.add_robot(kenaf_with({.flipper_compliance_radpnm = 0.02, .flipper_torque_scale = 0.1}), "a", {});
    world.set_command(id, drive(0, 0, -1.0, 1));
    for (int i = 0; i < 3 / step_s; ++i) {
      world.step();
      for (const double torque : world.truth(id).flipper_nm) REQUIRE(std::abs(torque) <= 2 + 1e-9);
    }
    const RobotTruth truth = world.truth(id);
    CHECK(std::abs(roll_pitch_yaw(truth.X_WB.q).y()) < 0.03);
    // the servo leads by what 2 N m bend, no further
    CHECK(truth.flipper_rad[robot::kFrontLeft] - truth.servo_rad[robot::kFrontLeft] == Approx(0.04).epsilon(0.03));
  }
}

TEST_CASE("Flipper play and compliance: torque, speed and brake, and the end of the travel") {
  World world(ground(), {}, 1);
  RobotDescription robot = kenaf_with({.flipper_backlash_rad = 0.1, .flipper_compliance_radpnm = 0.01});
  robot.flipper.front().max_angle_rad = 2;
  const RobotId id = world.add_robot(robot, "a", {});
  robot::Command command = drive(0, 0);
  for (robot::JointCommand& joint : command.flipper) joint = {robot::JointMode::speed, 0.5};
  world.set_command(id, command);
  run(world, 1);
  CHECK(world.truth(id).servo_rad[robot::kFrontLeft] == Approx(1.5).margin(0.01));
  run(world, 3);
  CHECK(world.truth(id).servo_rad[robot::kFrontLeft] == Approx(2).margin(0.01));
  CHECK(world.truth(id).flipper_rad[robot::kFrontLeft] < 2.01);
  for (robot::JointCommand& joint : command.flipper) joint = {robot::JointMode::torque, -20};
  world.set_command(id, command);
  run(world, 3);  // all arms press the ground with all they have
  for (const double angle : world.truth(id).flipper_rad) CHECK(angle < 0);
  for (robot::JointCommand& joint : command.flipper) joint = {robot::JointMode::brake, 0};
  world.set_command(id, command);
  // Servos stay; the robot wobbles on four arms that give way by half of the play and 10 mrad for each N m.
  const RobotTruth before = world.truth(id);
  for (int i = 0; i < 1500; ++i) {
    world.step();
    const RobotTruth truth = world.truth(id);
    for (std::size_t f = 0; f < robot::kFlipperCount; ++f) {
      REQUIRE(truth.servo_rad[f] == Approx(before.servo_rad[f]).margin(1e-3));
      REQUIRE(std::abs(truth.flipper_rad[f] - truth.servo_rad[f]) <= 0.05 + 0.01 * 20 + 1e-3);
      REQUIRE(std::abs(truth.flipper_nm[f]) <= 20 + 1e-9);
    }
  }
  const RobotTruth after = world.truth(id);
  for (std::size_t f = 0; f < robot::kFlipperCount; ++f)
    CHECK(std::abs(after.flipper_rad[f] - after.servo_rad[f]) < 0.05 + 0.01 * std::abs(after.flipper_nm[f]) + 0.01);
}

TEST_CASE("Flipper torque limit: the servo has that much less") {
  World world(ground(), {}, 1);
  const RobotId id = world.add_robot(kenaf_with({.flipper_torque_scale = 0.1}), "a", {});
  world.set_command(id, drive(0, 0, -1.0, 1));
  for (int i = 0; i < 2000; ++i) {
    world.step();
    for (const double torque : world.truth(id).flipper_nm) REQUIRE(std::abs(torque) <= 2 + 1e-9);
  }
  CHECK(std::abs(roll_pitch_yaw(world.truth(id).X_WB.q).y()) < 0.03);
}
