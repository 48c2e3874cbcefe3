// A world's gravity, of any strength and direction, moves bodies and sensors as mechanics predicts.
#include <catch2/catch.hpp>

#include "tests/physics/scenes.hpp"

using namespace kenaf::physics;

namespace {

constexpr double kMoon = 1.62, kJupiter = 24.79;

WorldDescription with_gravity(WorldDescription world, const Eigen::Vector3d& gravity_W_mps2) {
  world.gravity_W_mps2 = gravity_W_mps2;
  return world;
}

// How far a block slides down a slope of 30 degrees in `time_s`, from rest.
double slide_m(double gravity_mps2, double friction, double time_s) {
  const double slope = std::numbers::pi / 6;
  World world(with_gravity(ground(friction, slope), {0, 0, -gravity_mps2}), {}, 1);
  const Pose X_WP{Eigen::Vector3d::Zero(), rotation_from({0, slope, 0})};
  const BoxId box =
      world.add_box(loose_box({0.2, 0.2, 0.1}, compose(X_WP, {{0, 0, 0.05}, Eigen::Quaterniond::Identity()}), 2, 1));
  run(world, time_s);
  return (inverse(X_WP).q * world.box_pose(box).p).x();
}

ImuReading imu_at_rest(const WorldDescription& description) {
  RobotDescription robot = plain_tracks(1);
  SensorDescription imu{};
  imu.type = SensorType::imu;
  imu.name = "imu";
  imu.period_s = 0.01;
  robot.sensors = {imu};
  World world(description, {}, 1);
  const RobotId id = world.add_robot(robot, "a", {});
  run(world, 1);
  std::vector<SensorSample> samples;
  world.read_sensors(id, samples);
  return std::get<ImuReading>(samples.at(0).reading);
}

}  // namespace

// v after n steps is g h n, so the way is g h^2 n (n + 1) / 2, along each axis.
TEST_CASE("A body falls along gravity, wherever it points") {
  for (const Eigen::Vector3d& gravity : {Eigen::Vector3d(0, 0, -kMoon), Eigen::Vector3d(0, 0, 3),
                                         Eigen::Vector3d(-1, 2, -9.5), Eigen::Vector3d(0, 0, 0)}) {
    World world(with_gravity({}, gravity), {}, 1);
    const Eigen::Vector3d start(1, 2, 30);
    const BoxId box = world.add_box(loose_box({0.1, 0.1, 0.1}, {start, Eigen::Quaterniond::Identity()}, 1, 1));
    run(world, 1);
    const Eigen::Vector3d way = gravity * 1e-6 * 1000 * 1001 / 2;
    CHECK((world.box_pose(box).p - start - way).norm() < 1e-11);
  }
}

TEST_CASE("Whether a block holds on a slope of 30 degrees, tan 30 = 0.577, does not depend on gravity") {
  for (const double gravity : {kMoon, kJupiter}) {
    INFO(gravity);
    CHECK(std::abs(slide_m(gravity, 0.6, 5)) < 1e-3);
    CHECK(slide_m(gravity, 0.55, 2) > 0.02 * gravity);
  }
}

// s = g (sin 30 - mu cos 30) t^2 / 2. 1 %: the first millimetres while it settles.
TEST_CASE("A block slides in proportion to gravity") {
  for (const double gravity : {kMoon, kJupiter})
    for (const double mu : {0.0, 0.3}) {
      const double a = gravity * (0.5 - mu * std::sqrt(3.0) / 2);
      CHECK(slide_m(gravity, mu, 1) == Approx(a / 2).epsilon(0.01));
    }
}

// With gravity of 9.8 turned by 0.3 rad towards +x, level ground is a slope of 0.3 rad.
TEST_CASE("Under gravity that leans, level ground is a slope") {
  const double lean = 0.3, mu = 0.2;
  World world(with_gravity(ground(mu), 9.8 * Eigen::Vector3d(std::sin(lean), 0, -std::cos(lean))), {}, 1);
  const BoxId box = world.add_box(loose_box({0.2, 0.2, 0.1}, {{0, 0, 0.05}, Eigen::Quaterniond::Identity()}, 2, 1));
  run(world, 1);
  CHECK(world.box_pose(box).p.x() == Approx(9.8 * (std::sin(lean) - mu * std::cos(lean)) / 2).epsilon(0.01));
  CHECK(world.box_pose(box).p.z() == Approx(0.05).margin(1e-3));
}

// By friction alone: v^2 / (2 mu g), on the Moon 0.4^2 / (2 * 0.1 * 1.62) = 494 mm.
TEST_CASE("A robot on the Moon slides six times as far") {
  const double mu = 0.1, v = 0.4;
  RobotDescription robot = plain_tracks(mu);
  robot.drive.time_constant_s = 0;
  robot.drive.max_force_n = 1e5;
  World world(with_gravity(ground(), {0, 0, -kMoon}), {}, 1);
  const RobotId id = world.add_robot(robot, "a", {});
  world.set_command(id, drive(v, v));
  run(world, 5);  // v / (mu g) = 2.5 s to get there
  REQUIRE(world.truth(id).v_WB_mps.norm() == Approx(v).epsilon(1e-3));
  const Eigen::Vector3d start = world.truth(id).X_WB.p;
  world.set_command(id, drive(0, 0));
  run(world, 4);
  CHECK((world.truth(id).X_WB.p - start).norm() == Approx(v * v / (2 * mu * kMoon)).epsilon(0.005));
}

TEST_CASE("An inertial sensor at rest reads the reaction to the world's gravity, and posture against it") {
  const ImuReading moon = imu_at_rest(with_gravity(ground(), {0, 0, -kMoon}));
  CHECK(moon.acceleration_mps2.z() == Approx(kMoon).epsilon(1e-3));
  CHECK(moon.acceleration_mps2.head<2>().norm() < 1e-3);
  // gravity leans back by 0.1 rad: as on a slope that rises ahead, nose up (pitch is positive nose down)
  const Eigen::Vector3d leaning = 9.8 * Eigen::Vector3d(-std::sin(0.1), 0, -std::cos(0.1));
  const ImuReading slope = imu_at_rest(with_gravity(ground(), leaning));
  CHECK((slope.acceleration_mps2 + leaning).norm() < 0.02);
  CHECK(slope.roll_pitch_yaw_rad.y() == Approx(-0.1).margin(1e-3));
}
