// Flippers turn at their speed limit, lift the robot as far as the geometry of arm and tip predicts, and give up at
// their torque limit. Each mode and the ends of travel are checked, and so is the flipper's own belt, which carries the
// robot.
#include <catch2/catch.hpp>

#include "tests/physics/scenes.hpp"

using namespace kenaf;
using namespace kenaf::physics;

TEST_CASE("A flipper turns to its angle at its speed limit and stays") {
  World world(ground(), {}, 1);
  const RobotId id = world.add_robot(load_robot("kenaf"), "a", {});
  world.set_command(id, drive(0, 0, 1.9, 1.9));
  double fastest = 0;
  for (int i = 0; i < 500; ++i) {
    world.step();
    for (const double speed : world.truth(id).flipper_radps) fastest = std::max(fastest, std::abs(speed));
  }
  CHECK(fastest == Approx(1.5).epsilon(0.01));
  // 0.9 rad take 0.6 s; after 0.5 s it has come 0.75 rad far
  for (const double angle : world.truth(id).flipper_rad) CHECK(angle == Approx(1.75).margin(0.01));
  run(world, 0.5);
  for (const double angle : world.truth(id).flipper_rad) CHECK(angle == Approx(1.9).margin(1e-3));
}

TEST_CASE("Flippers lift the robot as their geometry says") {
  World world(ground(), {}, 1);
  const RobotDescription robot = load_robot("kenaf");
  const RobotId id = world.add_robot(robot, "a", {});
  world.set_command(id, drive(0, 0, -1.2, -1.2));
  run(world, 4);
  const RobotTruth truth = world.truth(id);
  for (const double angle : truth.flipper_rad) CHECK(angle == Approx(-1.2).margin(0.01));
  // on four tip drums: pivot height = length sin(1.2) + tip radius; 2 mm for drums made of flat faces and soft ground
  const FlipperDescription& f = robot.flipper.front();
  const double pivot = f.length_m * std::sin(1.2) + f.tip_radius_m;
  CHECK(truth.X_WB.p.z() == Approx(pivot - f.p_BPivot_m.z()).margin(2e-3));
  CHECK(std::abs(roll_pitch_yaw(truth.X_WB.q).y()) < 0.01);
  // each carries a quarter of the weight at length cos(1.2); friction under the tips may take a part of it
  for (const double torque : truth.flipper_nm) CHECK(std::abs(torque) < 20.0);
}

TEST_CASE("The front pair alone raises the nose") {
  World world(ground(), {}, 1);
  const RobotId id = world.add_robot(load_robot("kenaf"), "a", {});
  world.set_command(id, drive(0, 0, -1.0, 1));
  run(world, 3);
  CHECK(roll_pitch_yaw(world.truth(id).X_WB.q).y() < -0.15);  // nose up is negative
}

TEST_CASE("The torque limit holds, and a servo too weak lifts nothing") {
  World world(ground(), {}, 1);
  RobotDescription robot = load_robot("kenaf");
  robot.servo.max_torque_nm = 2;
  const RobotId id = world.add_robot(robot, "a", {});
  world.set_command(id, drive(0, 0, -1.0, 1));
  for (int i = 0; i < 3000; ++i) {
    world.step();
    for (const double torque : world.truth(id).flipper_nm) REQUIRE(std::abs(torque) <= 2 + 1e-9);
  }
  CHECK(std::abs(roll_pitch_yaw(world.truth(id).X_WB.q).y()) < 0.03);
}

TEST_CASE("Speed, torque and brake modes do what they are named for") {
  World world(ground(), {}, 1);
  const RobotId id = world.add_robot(load_robot("kenaf"), "a", {});
  robot::Command command = drive(0, 0);
  command.flipper[robot::kFrontLeft] = {robot::JointMode::speed, 0.5};
  world.set_command(id, command);
  run(world, 1);
  CHECK(world.truth(id).flipper_rad[robot::kFrontLeft] == Approx(1.5).margin(0.01));
  command.flipper[robot::kFrontLeft] = {robot::JointMode::brake, 0};
  world.set_command(id, command);
  run(world, 1);
  CHECK(world.truth(id).flipper_rad[robot::kFrontLeft] == Approx(1.5).margin(0.01));
  // without torque it falls to the ground
  command.flipper[robot::kFrontLeft] = {robot::JointMode::torque, 0};
  world.set_command(id, command);
  run(world, 2);
  CHECK(world.truth(id).flipper_rad[robot::kFrontLeft] < 0);
  command.flipper[robot::kFrontLeft] = {robot::JointMode::torque, 5};
  world.set_command(id, command);
  run(world, 0.5);
  CHECK(world.truth(id).flipper_radps[robot::kFrontLeft] == Approx(1.5).epsilon(0.01));
}

TEST_CASE("A flipper goes through the whole of its travel and stops at its end") {
  World world(ground(), {}, 1);
  RobotDescription robot = load_robot("kenaf");
  robot.flipper.front().max_angle_rad = 2.8;
  const RobotId id = world.add_robot(robot, "a", {});
  robot::Command command = drive(0, 0);
  for (robot::JointCommand& joint : command.flipper) joint = {robot::JointMode::speed, 1.0};
  world.set_command(id, command);
  run(world, 4);
  for (const double angle : world.truth(id).flipper_rad) CHECK(angle == Approx(2.8).margin(0.01));
}

TEST_CASE("A driven flipper belt carries the robot on its flippers") {
  for (const bool driven : {true, false}) {
    World world(ground(), {}, 1);
    RobotDescription robot = load_robot("kenaf");
    robot.flipper.front().belt_driven = driven;
    const RobotId id = world.add_robot(robot, "a", {});
    world.set_command(id, drive(0, 0, -1.2, -1.2));
    run(world, 3);
    const double before = world.truth(id).X_WB.p.x();
    world.set_command(id, drive(0.1, 0.1, -1.2, -1.2));
    run(world, 2);
    CHECK(world.truth(id).X_WB.p.x() - before == Approx(driven ? 0.195 : 0).margin(0.01));
  }
}

TEST_CASE("A robot with one pair of flippers has their mass alone, and takes commands to the others without effect") {
  const RobotDescription four = load_robot("kenaf");
  for (const bool front : {true, false}) {
    CAPTURE(front);
    const RobotDescription robot = kenaf_with_pair(front);
    CHECK(robot.flipper_count() == 2);
    CHECK(robot.has(robot::kFrontRight) == front);
    CHECK(robot.has(robot::kRearLeft) == !front);
    CHECK(robot.total_mass_kg() == Approx(four.total_mass_kg() - 2 * four.flipper.front().mass_kg));

    World world(ground(), {}, 1);
    const RobotId id = world.add_robot(robot, "a", {});
    world.set_command(id, drive(0, 0, 1.6, 1.6));
    run(world, 2);
    const RobotTruth truth = world.truth(id);
    for (const robot::Flipper which : {robot::kFrontLeft, robot::kFrontRight, robot::kRearLeft, robot::kRearRight})
      CHECK(truth.flipper_rad[which] == Approx(robot.has(which) ? 1.6 : 0.0).margin(1e-3));
    CHECK(truth.flipper_nm[front ? robot::kRearLeft : robot::kFrontLeft] == 0);
  }
}

TEST_CASE("One pair of flippers raises its own end of the robot") {
  for (const bool front : {true, false}) {
    World world(ground(), {}, 1);
    const RobotId id = world.add_robot(kenaf_with_pair(front), "a", {});
    world.set_command(id, drive(0, 0, -1.0, -1.0));
    run(world, 3);
    const double nose_down_rad = roll_pitch_yaw(world.truth(id).X_WB.q).y();
    CHECK((front ? -nose_down_rad : nose_down_rad) > 0.15);
  }
}

TEST_CASE("The drives' sensor reads nothing of flippers that are not there") {
  World world(ground(), {}, 1);
  const RobotId id = world.add_robot(kenaf_with_pair(true), "a", {});
  world.set_command(id, drive(0.1, 0.1));
  run(world, 0.5);
  std::vector<SensorSample> samples;
  world.read_sensors(id, samples);
  bool any = false;
  for (const SensorSample& sample : samples) {
    const auto* drives = std::get_if<DrivesReading>(&sample.reading);
    if (drives == nullptr) continue;
    any = true;
    CHECK(drives->flipper_rad[robot::kFrontLeft] == Approx(1).margin(0.05));
    CHECK(drives->flipper_rad[robot::kRearLeft] == 0);
    CHECK(drives->flipper_a[robot::kRearRight] == 0);
  }
  CHECK(any);
}
