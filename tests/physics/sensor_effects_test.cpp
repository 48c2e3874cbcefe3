// Effects of the sensor stage, and what encoders and drives report of joints and noise.
#include <catch2/catch.hpp>

#include "physics/terrain_effects.hpp"
#include "tests/physics/scenes.hpp"

using namespace kenaf;
using namespace kenaf::physics;

namespace {

SensorDescription exact(SensorType type) {
  SensorDescription sensor{};
  sensor.type = type;
  sensor.name = std::string(usarsim_type_name(type));
  return sensor;
}

RobotDescription robot_with(const Effects& effects, std::initializer_list<SensorType> types) {
  RobotDescription robot = load_robot("kenaf");
  robot.effects = effects;
  robot.sensors.clear();
  for (const SensorType type : types) robot.sensors.push_back(exact(type));
  return robot;
}

std::vector<SensorSample> read(World& world, RobotId id) {
  std::vector<SensorSample> samples;
  world.read_sensors(id, samples);
  return samples;
}

// Roll, pitch, yaw of INS and IMU of a robot that is in the air at that posture, in a world with the given gravity.
std::array<Eigen::Vector3d, 2> postures(const Eigen::Vector3d& rpy, const Effects& effects) {
  World world(with_terrain_effects({}, effects), {}, 1);
  const RobotId id = world.add_robot(robot_with(effects, {SensorType::ins, SensorType::imu}), "a",
                                     {Eigen::Vector3d::Zero(), rotation_from(rpy)});
  const auto samples = read(world, id);
  return {std::get<InsReading>(samples[0].reading).roll_pitch_yaw_rad,
          std::get<ImuReading>(samples[1].reading).roll_pitch_yaw_rad};
}

}  // namespace

TEST_CASE("Encoder scale: travel, speed and odometry, but not the robot") {
  const Effects effects{.encoder_scale = 1.1};
  World world(ground(), {}, 1);
  const RobotId id = world.add_robot(
      robot_with(effects, {SensorType::encoder, SensorType::odometry, SensorType::tachometer}), "a", {});
  world.set_command(id, drive(0.2, 0.2));
  run(world, 2);
  const RobotTruth truth = world.truth(id);
  CHECK(truth.X_WB.p.x() == Approx(0.39).margin(2e-3));
  const auto samples = read(world, id);
  const double turned_rad = 1.1 * truth.track_m[robot::kLeft] / 0.065;
  CHECK(static_cast<double>(std::get<EncoderReading>(samples[0].reading).counts[robot::kLeft]) ==
        Approx(turned_rad * 2000 / (2 * std::numbers::pi)).margin(1));
  CHECK(std::get<OdometryReading>(samples[1].reading).x_m == Approx(1.1 * truth.track_m[robot::kLeft]).margin(3e-4));
  const auto tachometer = std::get<TachometerReading>(samples[2].reading);
  CHECK(tachometer.spin_radps[robot::kLeft] == Approx(1.1 * truth.track_mps[robot::kLeft] / 0.065));
  CHECK(tachometer.angle_rad[robot::kLeft] == Approx(turned_rad));
}

TEST_CASE("Encoder asymmetry: of a way straight ahead, half of it more on the left and less on the right") {
  World world(ground(), {}, 1);
  const RobotId id = world.add_robot(robot_with({.encoder_scale = 1.1, .encoder_asymmetry = 0.1},
                                                {SensorType::encoder, SensorType::odometry, SensorType::tachometer}),
                                     "a", {});
  world.set_command(id, drive(0.2, 0.2));
  run(world, 2);
  const RobotTruth truth = world.truth(id);
  const auto samples = read(world, id);
  const auto& counts = std::get<EncoderReading>(samples[0].reading).counts;
  const auto& tachometer = std::get<TachometerReading>(samples[2].reading);
  for (const auto& [side, factor] : {std::pair{robot::kLeft, 1.1 * 1.05}, std::pair{robot::kRight, 1.1 * 0.95}}) {
    const double turned_rad = factor * truth.track_m[side] / 0.065;
    CHECK(static_cast<double>(counts[side]) == Approx(turned_rad * 2000 / (2 * std::numbers::pi)).margin(1));
    CHECK(tachometer.spin_radps[side] == Approx(factor * truth.track_mps[side] / 0.065));
    CHECK(tachometer.angle_rad[side] == Approx(turned_rad));
  }
  // the odometry thinks that the robot has turned to the right
  CHECK(std::get<OdometryReading>(samples[1].reading).yaw_rad ==
        Approx(-1.1 * 0.1 * truth.track_m[robot::kLeft] / 0.2).margin(5e-3));
  CHECK(std::abs(yaw_of(truth.X_WB)) < 1e-3);
}

TEST_CASE("Gyro: rates in the body times scale, and a bias about z alone") {
  WorldDescription empty;
  empty.gravity_W_mps2.setZero();
  World world(empty, {}, 1);
  RobotDescription robot = robot_with({.gyro_bias_z_radps = 0.05, .gyro_scale = 1.2}, {SensorType::imu});
  const Eigen::Quaterniond q_WB = rotation_from({0.1, 0.2, 0.7});
  const RobotId id = world.add_robot(robot, "a", {Eigen::Vector3d::Zero(), q_WB});
  RobotMotion motion;
  motion.w_WB_radps = {0.3, -0.2, 0.5};
  world.set_in_motion(id, motion, {});
  const auto imu = std::get<ImuReading>(read(world, id)[0].reading);
  const Eigen::Vector3d expected = 1.2 * (q_WB.conjugate() * motion.w_WB_radps) + Eigen::Vector3d(0, 0, 0.05);
  CHECK((imu.angular_velocity_radps - expected).norm() < 1e-12);
}

TEST_CASE("Gyro delay: rates of then, in proportion between two steps, while posture and acceleration are in time") {
  const auto driven = [](double delay_s) {
    World world(ground(), {}, 1);
    RobotDescription robot = robot_with({.gyro_delay_s = delay_s}, {SensorType::imu});
    robot.sensors[0].delay_s = 0.01;
    const RobotId id = world.add_robot(robot, "a", {});
    std::vector<ImuReading> readings;
    for (int i = 0; i < 1200; ++i) {
      world.set_command(id, i < 600 ? drive(-0.2, 0.2) : drive(0.2, 0.1));
      world.step();
      readings.push_back(std::get<ImuReading>(read(world, id)[0].reading));
    }
    return readings;
  };
  const auto prompt = driven(0);
  for (const double steps : {20.0, 20.5, 500.0, 1000.0}) {
    const auto late = driven(steps * 0.001);
    const auto whole = static_cast<std::size_t>(steps);
    const double rest = steps - static_cast<double>(whole);
    for (std::size_t i = whole + 1; i < late.size(); i += 7) {
      const Eigen::Vector3d newer = prompt[i - whole].angular_velocity_radps,
                            older = prompt[i - whole - 1].angular_velocity_radps;
      REQUIRE((late[i].angular_velocity_radps - newer - rest * (older - newer)).norm() < 1e-9);
      REQUIRE(late[i].acceleration_mps2 == prompt[i].acceleration_mps2);
      REQUIRE(late[i].roll_pitch_yaw_rad == prompt[i].roll_pitch_yaw_rad);
    }
  }
}

TEST_CASE("Posture bias and scale: INS and IMU alike, yaw is no posture") {
  for (const Eigen::Vector3d& angles : postures({0.1, 0.2, 0.7}, {.posture_bias_rad = 0.05, .posture_scale = 1.2}))
    CHECK((angles - Eigen::Vector3d(0.12, 0.29, 0.7)).norm() < 1e-12);
}

TEST_CASE("Posture mount: a sensor turned to the left takes a part of the pitch for roll") {
  // Nose down by p, turned by m: along the sensor's x axis the ground falls by sin p cos m, and its right side, which
  // looks ahead, lies lower by sin p sin m.
  const double p = 0.4, m = 0.3;
  for (const Eigen::Vector3d& angles : postures({0, p, 0.7}, {.posture_mount_rad = m})) {
    CHECK(std::sin(angles.y()) == Approx(std::sin(p) * std::cos(m)));
    CHECK(std::sin(angles.x()) * std::cos(angles.y()) == Approx(std::sin(p) * std::sin(m)));
    CHECK(angles.z() == Approx(0.7));
  }
  // roll to the right by r: the sensor's x axis looks to the left, which is up
  const double r = 0.2;
  for (const Eigen::Vector3d& angles : postures({r, 0, 0}, {.posture_mount_rad = m}))
    CHECK(std::sin(angles.y()) == Approx(-std::sin(r) * std::sin(m)));
}

TEST_CASE("Posture is against gravity: on a world that falls away the robot is not level") {
  for (const Eigen::Vector3d& angles : postures({0, 0, 0}, {.ground_slope_rad = 0.1}))
    CHECK((angles - Eigen::Vector3d(0, 0.1, 0)).norm() < 1e-12);
  for (const Eigen::Vector3d& angles : postures({0, 0, 0}, {.ground_bank_rad = 0.1}))
    CHECK((angles - Eigen::Vector3d(0.1, 0, 0)).norm() < 1e-12);
  // looking back up the slope
  for (const Eigen::Vector3d& angles : postures({0, 0, std::numbers::pi}, {.ground_slope_rad = 0.1}))
    CHECK(angles.y() == Approx(-0.1));
  // an accelerometer at rest feels the same direction
  World world(with_terrain_effects(ground(), {.ground_slope_rad = 0.1}), {}, 1);
  const RobotId id =
      world.add_robot(robot_with({}, {SensorType::ins, SensorType::imu, SensorType::ground_truth}), "a", {});
  run(world, 1);
  const auto samples = read(world, id);
  const Eigen::Vector3d a = std::get<ImuReading>(samples[1].reading).acceleration_mps2;
  CHECK(std::atan2(-a.x(), a.z()) == Approx(0.1).margin(2e-3));
  CHECK(std::get<InsReading>(samples[0].reading).roll_pitch_yaw_rad.y() == Approx(0.1).margin(2e-3));
  CHECK(std::abs(std::get<GroundTruthReading>(samples[2].reading).roll_pitch_yaw_rad.y()) < 2e-3);
}

TEST_CASE("Posture: an INS that is reset to a pose on a slope reports that pose") {
  World world(with_terrain_effects(ground(), {.ground_slope_rad = 0.1}), {}, 1);
  const RobotId id = world.add_robot(robot_with({}, {SensorType::ins}), "a", {});
  world.reset_sensor(id, 0, GroundTruthReading{{1, 2, 3}, {0.05, -0.1, 0.3}});
  const auto ins = std::get<InsReading>(read(world, id)[0].reading);
  CHECK((ins.p_WB_m - Eigen::Vector3d(1, 2, 3)).norm() < 1e-12);
  CHECK((ins.roll_pitch_yaw_rad - Eigen::Vector3d(0.05, -0.1, 0.3)).norm() < 1e-12);
}

TEST_CASE("Posture delay: what was then, in proportion between two steps, under the time of a sensor in time") {
  for (const double delay_s : {0.02, 0.0205, 0.5}) {
    World world(ground(), {}, 1);
    RobotDescription robot = robot_with({.posture_delay_s = delay_s}, {SensorType::ins, SensorType::imu});
    robot.sensors[0].delay_s = 0.01;
    const RobotId id = world.add_robot(robot, "a", {});
    world.set_command(id, drive(-0.2, 0.2));
    std::vector<RobotTruth> past;
    for (int i = 0; i < 1000; ++i) {
      world.step();
      past.push_back(world.truth(id));
    }
    const auto yaw_ago = [&past](double steps) {
      const auto whole = static_cast<std::size_t>(steps + 1e-6);
      const double newer = yaw_of(past[past.size() - 1 - whole].X_WB),
                   older = yaw_of(past[past.size() - 2 - whole].X_WB);
      return newer + (steps - static_cast<double>(whole)) * (older - newer);
    };
    const auto samples = read(world, id);
    CHECK(samples[0].t_s == Approx(0.99));
    CHECK(std::get<InsReading>(samples[0].reading).roll_pitch_yaw_rad.z() ==
          Approx(yaw_ago((0.01 + delay_s) / 0.001)).margin(1e-9));
    const auto imu = std::get<ImuReading>(samples[1].reading);
    CHECK(imu.roll_pitch_yaw_rad.z() == Approx(yaw_ago(delay_s / 0.001)).margin(1e-9));
    CHECK(imu.angular_velocity_radps.z() == Approx(past.back().w_WB_radps.z()));  // rates are not posture
  }
}

TEST_CASE("Drives report the servos' angles, in steps of their encoder") {
  RobotDescription robot = robot_with({.flipper_backlash_rad = 0.2}, {SensorType::drives});
  for (const double resolution_rad : {0.0, 0.07}) {
    robot.servo.resolution_rad = resolution_rad;
    World world(ground(), {}, 1);
    const RobotId id = world.add_robot(robot, "a", {});
    world.set_command(id, drive(0, 0, 0.5, 0.5));
    run(world, 2);
    // the servo is where it was commanded; the arm hangs in its play. 7 x 0.07 = 0.49
    CHECK(world.truth(id).flipper_rad[robot::kFrontLeft] == Approx(0.4).margin(2e-3));
    CHECK(std::get<DrivesReading>(read(world, id)[0].reading).flipper_rad[robot::kFrontLeft] ==
          Approx(resolution_rad > 0 ? 0.49 : 0.5).margin(1e-3));
  }
}

TEST_CASE("Drives and encoders have noise of their own, where the description says so") {
  RobotDescription robot = robot_with({}, {SensorType::drives, SensorType::encoder});
  robot.sensors[0].noise_a = 0.2;
  robot.sensors[0].noise_v = 0.1;
  robot.sensors[0].noise_rad = 0.01;
  robot.sensors[1].noise_rad = 0.05;
  World world(ground(), {}, 1);
  const RobotId id = world.add_robot(robot, "a", {});
  run(world, 0.5);
  constexpr int kSamples = 4000;
  std::array<double, 4> sum{}, squares{};
  for (int i = 0; i < kSamples; ++i) {
    world.step();
    const auto samples = read(world, id);
    const auto& drives = std::get<DrivesReading>(samples[0].reading);
    const double counts = static_cast<double>(std::get<EncoderReading>(samples[1].reading).counts[robot::kRight]);
    const std::array<double, 4> now{drives.track_a[robot::kLeft], drives.battery_v,
                                    drives.flipper_rad[robot::kRearRight], counts};
    for (std::size_t k = 0; k < 4; ++k) {
      sum[k] += now[k];
      squares[k] += now[k] * now[k];
    }
  }
  // counts are 2000 a turn; 5 % is more than four sigma of a sample sigma of 4000
  const std::array<double, 4> sigma{0.2, 0.1, 0.01, 0.05 * 2000 / (2 * std::numbers::pi)};
  for (std::size_t k = 0; k < 4; ++k) {
    const double mean = sum[k] / kSamples;
    CHECK(std::sqrt(squares[k] / kSamples - mean * mean) == Approx(sigma[k]).epsilon(0.05));
  }
}
