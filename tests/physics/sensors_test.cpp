// Each kind of sensor reports the values that the robot's known motion or a scene of known distances implies. The tests
// also check its rate, its delay, its reset, and the statistics of its noise and bias against those of a normal
// distribution.
#include <catch2/catch.hpp>

#include "physics/noise.hpp"
#include "tests/physics/scenes.hpp"

using namespace kenaf;
using namespace kenaf::physics;

namespace {

RobotDescription with_sensor(const SensorDescription& sensor) {
  RobotDescription robot = load_robot("kenaf");
  robot.sensors = {sensor};
  return robot;
}

SensorDescription sensor_of(SensorType type) {
  SensorDescription sensor{};
  sensor.type = type;
  sensor.name = "sensor";
  return sensor;
}

template <typename T>
T read_one(World& world, RobotId id) {
  std::vector<SensorSample> samples;
  world.read_sensors(id, samples);
  REQUIRE(samples.size() == 1);
  return std::get<T>(samples.front().reading);
}

}  // namespace

TEST_CASE("A sensor reports once a period, and at every call where it has none") {
  RobotDescription robot = load_robot("kenaf");
  robot.sensors = {sensor_of(SensorType::ground_truth), sensor_of(SensorType::ins)};
  robot.sensors[1].period_s = 0.05;
  World world(ground(), {}, 1);
  const RobotId id = world.add_robot(robot, "a", {});
  std::array<int, 2> reports{};
  std::vector<SensorSample> samples;
  for (int i = 0; i < 1000; ++i) {
    samples.clear();
    world.read_sensors(id, samples);
    world.read_sensors(id, samples);  // nothing new without a step
    for (const SensorSample& sample : samples) {
      ++reports[sample.sensor];
      CHECK(sample.t_s == world.time_s());
    }
    world.step();
  }
  CHECK(reports[0] == 1000);
  CHECK(reports[1] == 20);
}

TEST_CASE("Noise is white, of its sigma, bias is drawn once, other names, other noise") {
  SensorDescription sensor = sensor_of(SensorType::ins);
  sensor.noise_rad = 0.01;
  sensor.noise_m = 0.02;
  sensor.bias_rad = 0.1;
  World world(ground(), {}, 3);
  const RobotId id = world.add_robot(with_sensor(sensor), "a", {});
  const RobotId other = world.add_robot(with_sensor(sensor), "b", {{5, 0, 0}, Eigen::Quaterniond::Identity()});
  run(world, 0.5);
  constexpr int kSamples = 4000;
  double sum = 0, squares = 0, position_squares = 0, successive = 0, last = 0, other_sum = 0;
  for (int i = 0; i < kSamples; ++i) {
    world.step();
    const auto reading = read_one<InsReading>(world, id);
    const double roll = reading.roll_pitch_yaw_rad.x(), y = reading.p_WB_m.y();
    other_sum += read_one<InsReading>(world, other).roll_pitch_yaw_rad.x();
    sum += roll;
    squares += roll * roll;
    successive += i ? (roll - last) * (roll - last) : 0;
    last = roll;
    position_squares += y * y;
  }
  const double mean = sum / kSamples, sigma = std::sqrt(squares / kSamples - mean * mean);
  // a sample sigma of n draws is off by sigma / sqrt(2 n), 1.1 %: 5 % is more than four of those
  CHECK(sigma == Approx(0.01).epsilon(0.05));
  CHECK(std::sqrt(position_squares / kSamples) == Approx(0.02).epsilon(0.05));
  // white: successive differences have twice the variance
  CHECK(successive / (kSamples - 1) == Approx(2 * sigma * sigma).epsilon(0.08));
  CHECK(std::abs(mean) > 1e-3);  // this seed's bias
  CHECK(std::abs(mean) < 0.5);
  CHECK(std::abs(mean - other_sum / kSamples) > 1e-3);
}

TEST_CASE("The generator is normal") {
  NoiseSource noise(1, "robot", "sensor");
  int within = 0;
  constexpr int kDraws = 100000;
  for (int i = 0; i < kDraws; ++i) within += std::abs(noise.normal()) < 1;
  CHECK(within / double(kDraws) == Approx(0.6827).margin(0.005));
}

TEST_CASE("A late sensor reports what was") {
  SensorDescription sensor = sensor_of(SensorType::ground_truth);
  sensor.delay_s = 0.03;
  World world(ground(), {}, 1);
  const RobotId id = world.add_robot(with_sensor(sensor), "a", {});
  world.set_command(id, drive(0.4, 0.4));
  std::vector<double> x;
  for (int i = 0; i < 300; ++i) {
    world.step();
    x.push_back(world.truth(id).X_WB.p.x());
  }
  std::vector<SensorSample> samples;
  world.read_sensors(id, samples);
  CHECK(samples.front().t_s == Approx(0.27));
  CHECK(std::get<GroundTruthReading>(samples.front().reading).p_WB_m.x() == x[269]);
}

TEST_CASE("Encoders count the sprocket's turning, odometry and tachometer follow") {
  RobotDescription robot = load_robot("kenaf");
  robot.sensors = {sensor_of(SensorType::encoder), sensor_of(SensorType::odometry), sensor_of(SensorType::tachometer)};
  World world(ground(), {}, 1);
  const RobotId id = world.add_robot(robot, "a", {});
  world.set_command(id, drive(0.2, 0.2));
  run(world, 2);
  std::vector<SensorSample> samples;
  world.read_sensors(id, samples);
  const double travel = world.truth(id).track_m[robot::kLeft];
  CHECK(travel == Approx(0.39).margin(1e-3));
  const auto counts = std::get<EncoderReading>(samples[0].reading).counts;
  CHECK(static_cast<double>(counts[robot::kLeft]) == Approx(travel / 0.065 * 2000 / (2 * std::numbers::pi)).margin(1));
  const auto odometry = std::get<OdometryReading>(samples[1].reading);
  CHECK(odometry.x_m == Approx(travel).margin(3e-4));
  CHECK(std::abs(odometry.yaw_rad) < 2e-3);
  const auto tachometer = std::get<TachometerReading>(samples[2].reading);
  CHECK(tachometer.spin_radps[robot::kRight] == Approx(0.2 / 0.065).epsilon(1e-3));
  CHECK(tachometer.angle_rad[robot::kLeft] == Approx(travel / 0.065));
}

TEST_CASE("An inertial sensor feels gravity's reaction, acceleration and turning") {
  SensorDescription sensor = sensor_of(SensorType::imu);
  sensor.period_s = 0.01;
  World world(ground(), {}, 1);
  const RobotId id = world.add_robot(with_sensor(sensor), "a", {});
  run(world, 0.5);
  const auto rest = read_one<ImuReading>(world, id);
  CHECK(rest.acceleration_mps2.z() == Approx(kGravity).epsilon(1e-3));
  CHECK(std::abs(rest.acceleration_mps2.x()) < 0.01);
  world.set_command(id, drive(0.4, 0.4));
  run(world, 0.02);
  const double v0 = world.truth(id).v_WB_mps.x();
  run(world, 0.01);
  const double v1 = world.truth(id).v_WB_mps.x();
  CHECK(read_one<ImuReading>(world, id).acceleration_mps2.x() == Approx((v1 - v0) / 0.01).epsilon(1e-3));
  CHECK(v1 - v0 > 0.01);
  world.set_command(id, drive(-0.2, 0.2));
  run(world, 1);
  CHECK(read_one<ImuReading>(world, id).angular_velocity_radps.z() ==
        Approx(world.truth(id).w_WB_radps.z()).epsilon(1e-6));
}

TEST_CASE("A sonar sees the nearest in its cone, a scanner from left to right") {
  WorldDescription description = ground();
  description.boxes.push_back(fixed_box({0.2, 1, 2}, {2.1, 0, 1}));  // ahead, face at x = 2
  description.boxes.push_back(fixed_box({1, 0.2, 2}, {0, 1.6, 1}));  // to the left, face at y = 1.5
  RobotDescription robot = load_robot("kenaf");
  SensorDescription sonar = sensor_of(SensorType::sonar);
  sonar.X_BS.p = {0.2, 0, 0.1};
  sonar.min_range_m = 0.05;
  sonar.max_range_m = 5;
  sonar.field_of_view_rad = 0.1;
  SensorDescription scanner = sensor_of(SensorType::range_scanner);
  scanner.name = "scanner";
  scanner.X_BS.p = {0, 0, 0.1};
  scanner.max_range_m = 4;
  scanner.field_of_view_rad = std::numbers::pi;
  scanner.resolution_rad = std::numbers::pi / 180;
  robot.sensors = {sonar, scanner};
  World world(description, {}, 1);
  const RobotId id = world.add_robot(robot, "a", {});
  std::vector<SensorSample> samples;
  world.read_sensors(id, samples);
  CHECK(std::get<SonarReading>(samples[0].reading).range_m == Approx(1.8).margin(5e-3));
  const auto& scan = std::get<RangeScanReading>(samples[1].reading).range_m;
  REQUIRE(scan.size() == 181);
  CHECK(scan[0] == Approx(1.5).margin(5e-3));
  CHECK(scan[90] == Approx(2.0).margin(5e-3));
  CHECK(scan[180] == 4);
}

TEST_CASE("GPS: x is east, y is north, and a roof takes the fix") {
  World world(ground(), {}, 1);
  const RobotId id =
      world.add_robot(with_sensor(sensor_of(SensorType::gps)), "a", {{0, 1000, 0}, Eigen::Quaterniond::Identity()});
  const auto north = read_one<GpsReading>(world, id);
  CHECK(north.fix);
  // a degree of latitude is 111.0 km at 39 degrees
  CHECK(north.latitude_deg - 39.13383333 == Approx(1 / 111.01).epsilon(2e-3));
  CHECK(north.longitude_deg == Approx(-77.21666667));
  world.add_box(fixed_box({2, 2, 0.1}, {0, 1000, 3}));
  world.step();
  CHECK_FALSE(read_one<GpsReading>(world, id).fix);
}

TEST_CASE("A touch sensor feels an obstacle at its mount, and not the ground") {
  WorldDescription description = ground();
  description.boxes.push_back(fixed_box({0.2, 1, 1}, {0.5, 0, 0.5}));
  SensorDescription sensor = sensor_of(SensorType::touch);
  sensor.X_BS.p = {0.29, 0, 0};
  World world(description, {}, 1);
  const RobotId id = world.add_robot(with_sensor(sensor), "a", {});
  robot::Command command = drive(0, 0, 1.8, 1.8);
  world.set_command(id, command);
  run(world, 1);
  CHECK_FALSE(read_one<TouchReading>(world, id).touched);
  command.track_speed_mps = {0.1, 0.1};
  world.set_command(id, command);
  bool touched = false;
  for (int i = 0; i < 150 && !touched; ++i) {
    run(world, 0.01);
    touched = read_one<TouchReading>(world, id).touched;
  }
  CHECK(touched);
  // the track's front is 0.29 m ahead of the centre, the box begins at 0.4
  const Pose X_WB = world.truth(id).X_WB;
  CHECK(X_WB.p.x() == Approx(0.11).margin(0.005));
  // 50 mm back nothing touches it; what did is still within 0.1 m of the sensor
  world.step();
  world.teleport(id, {X_WB.p - Eigen::Vector3d(0.05, 0, 0), X_WB.q});
  CHECK_FALSE(read_one<TouchReading>(world, id).touched);
}

TEST_CASE("Two robots that meet both feel it, one beside them does not") {
  SensorDescription sensor = sensor_of(SensorType::touch);
  sensor.X_BS.p = {0.29, 0, 0};
  World world(ground(), {}, 1);
  const RobotId beside = world.add_robot(with_sensor(sensor), "beside", {{0, 3, 0}});
  const RobotId a = world.add_robot(with_sensor(sensor), "a", {});
  const RobotId b = world.add_robot(with_sensor(sensor), "b", {{0.7, 0, 0}, rotation_from({0, 0, std::numbers::pi})});
  for (const RobotId id : {beside, a, b}) world.set_command(id, drive(0, 0, 1.8, 1.8));
  run(world, 1);
  for (const RobotId id : {beside, a, b}) CHECK_FALSE(read_one<TouchReading>(world, id).touched);
  // the tracks' fronts are 0.29 m ahead of the centres, so 0.12 m apart
  world.set_command(a, drive(0.1, 0.1, 1.8, 1.8));
  run(world, 1.5);
  CHECK(read_one<TouchReading>(world, a).touched);
  CHECK(read_one<TouchReading>(world, b).touched);
  CHECK_FALSE(read_one<TouchReading>(world, beside).touched);
}

TEST_CASE("Currents follow force, the battery sags with them and runs down") {
  RobotDescription robot = with_sensor(sensor_of(SensorType::drives));
  World world(ground(), {}, 1);
  const RobotId id = world.add_robot(robot, "a", {});
  run(world, 1);
  const auto idle = read_one<DrivesReading>(world, id);
  CHECK(idle.track_a[robot::kLeft] < 0.05);
  world.set_command(id, drive(-0.3, 0.3));
  run(world, 1);
  const auto turning = read_one<DrivesReading>(world, id);
  const RobotTruth truth = world.truth(id);
  CHECK(turning.track_a[robot::kLeft] == Approx(0.04 * std::abs(truth.track_force_n[robot::kLeft]) + 0.3));
  CHECK(turning.track_a[robot::kLeft] > 1);
  // The battery gives a motor's current for the share of time in which the bridge is on: force over 300 N plus speed
  // over 0.5 m/s, of the voltage there is. The arms stand still and hold their weight against 20 N m.
  const double voltage_share = turning.battery_v / 25.9;
  double total = 0;
  for (const robot::Track side : {robot::kLeft, robot::kRight}) {
    const double force_n = std::abs(truth.track_force_n[side]), speed_share = std::abs(truth.track_mps[side]) / 0.5;
    total += (0.04 * force_n * (force_n / 300 + speed_share) + 0.3 * speed_share) / voltage_share;
  }
  for (const double a : turning.flipper_a) total += a * (a / 0.25 / 20) / voltage_share;
  CHECK(total > 1);
  CHECK(turning.battery_v == Approx(25.9 - 0.1 * total).epsilon(2e-4));
  CHECK(truth.battery_left_s == Approx(3600 - 2));
}

TEST_CASE("An arm that rests on its mechanical stop carries the robot without current") {
  // arms that can go no higher than 0.6 rad below the belts, servos limp: the ground presses those that it rests on
  // against their stops
  RobotDescription robot = with_sensor(sensor_of(SensorType::drives));
  robot.flipper.front().max_angle_rad = -0.6;
  World world(ground(), {}, 1);
  const RobotId id = world.add_robot(robot, "a", {});
  robot::Command command = drive(0, 0);
  for (robot::JointCommand& joint : command.flipper) joint = {robot::JointMode::torque, 0};
  world.set_command(id, command);
  run(world, 3);
  const RobotTruth truth = world.truth(id);
  double carried_nm = 0;
  for (const double torque : truth.flipper_nm) carried_nm += std::abs(torque);
  CHECK(truth.X_WB.p.z() > 0.1);
  CHECK(carried_nm > 2);  // which a servo would give for 0.5 A
  for (const double current : read_one<DrivesReading>(world, id).flipper_a) CHECK(current < 0.01);
}

TEST_CASE("A reset sensor starts from zero, an INS from the given pose") {
  RobotDescription robot = load_robot("kenaf");
  robot.sensors = {sensor_of(SensorType::encoder), sensor_of(SensorType::odometry), sensor_of(SensorType::ins)};
  World world(ground(), {}, 1);
  const RobotId id = world.add_robot(robot, "a", {});
  world.set_command(id, drive(0.2, 0.2));
  run(world, 1);
  for (std::size_t i = 0; i < 3; ++i) world.reset_sensor(id, i);
  world.reset_sensor(id, 2, GroundTruthReading{{10, 20, 0}, {0, 0, std::numbers::pi / 2}});
  run(world, 1);
  std::vector<SensorSample> samples;
  world.read_sensors(id, samples);
  CHECK(static_cast<double>(std::get<EncoderReading>(samples[0].reading).counts[robot::kLeft]) ==
        Approx(0.2 / 0.065 * 2000 / (2 * std::numbers::pi)).margin(2));
  CHECK(std::get<OdometryReading>(samples[1].reading).x_m == Approx(0.2).margin(1e-3));
  // it believes to look along +y, so 0.2 m ahead are 0.2 m in y
  const auto ins = std::get<InsReading>(samples[2].reading);
  CHECK(ins.p_WB_m.x() == Approx(10).margin(2e-3));
  CHECK(ins.p_WB_m.y() == Approx(20.2).margin(2e-3));
  CHECK(ins.roll_pitch_yaw_rad.z() == Approx(std::numbers::pi / 2).margin(2e-3));
  CHECK_THROWS_AS(world.reset_sensor(id, 9), std::out_of_range);
}

TEST_CASE("One side of an encoder is reset, and the other one counts on") {
  RobotDescription robot = load_robot("kenaf");
  robot.sensors = {sensor_of(SensorType::encoder)};
  World world(ground(), {}, 1);
  const RobotId id = world.add_robot(robot, "a", {});
  world.set_command(id, drive(0.2, 0.2));
  run(world, 1);
  world.reset_track_sensor(id, 0, robot::kLeft);
  run(world, 1);
  // 0.2 m/s for 1 s on a sprocket of 0.065 m with 2000 counts a turn: 979; for twice as long, less the start: 1950
  const auto counts = read_one<EncoderReading>(world, id).counts;
  const double counts_in_1s = 0.2 / 0.065 * 2000 / (2 * std::numbers::pi);
  CHECK(static_cast<double>(counts[robot::kLeft]) == Approx(counts_in_1s).margin(2));
  CHECK(static_cast<double>(counts[robot::kRight]) > 1.9 * counts_in_1s);
  CHECK_THROWS_AS(world.reset_track_sensor(id, 9, robot::kLeft), std::out_of_range);
}

TEST_CASE("Instruments that are put on a robot on its way count the way from there") {
  const RobotDescription kenaf = load_robot("kenaf");
  World world(ground(), {}, 1);
  const RobotId id = world.add_robot(kenaf, "robot", {});
  world.set_command(id, drive(0.2, 0.2));
  run(world, 2);
  REQUIRE(world.truth(id).X_WB.p.x() > 0.3);
  world.add_instruments(id, kenaf);
  run(world, 0.5);
  std::vector<SensorSample> samples;
  world.read_sensors(id, samples, 1);
  bool any = false;
  for (const SensorSample& sample : samples)
    if (const auto* odometry = std::get_if<OdometryReading>(&sample.reading)) {
      CHECK(odometry->x_m == Approx(0.1).margin(2e-3));  // 0.2 m/s for 0.5 s
      any = true;
    }
  CHECK(any);
}

TEST_CASE("Instruments report what the sensors of a robot would that moves alike, and stay until it is removed") {
  RobotDescription plain = load_robot("kenaf"), biased = plain;
  biased.effects.gyro_bias_z_radps = 0.1;
  biased.effects.gyro_delay_s = 0.05;
  World world(ground(), {}, 1), other(ground(), {}, 1);
  const RobotId id = world.add_robot(plain, "robot", {}), with_own = other.add_robot(biased, "robot", {});
  CHECK(world.add_instruments(id, biased) == 1);
  robot::Command turn;
  turn.track_speed_mps = {-0.2, 0.2};
  const auto readings_agree = [&] {
    world.set_command(id, turn);
    other.set_command(with_own, turn);
    for (int i = 0; i < 200; ++i) {
      world.step();
      other.step();
    }
    std::vector<SensorSample> instruments, sensors, own;
    world.read_sensors(id, instruments, 1);
    other.read_sensors(with_own, sensors);
    world.read_sensors(id, own);
    const auto rate_of = [](const std::vector<SensorSample>& samples) {
      for (const SensorSample& sample : samples)
        if (const auto* imu = std::get_if<ImuReading>(&sample.reading)) return imu->angular_velocity_radps.z();
      return 0.0;
    };
    return rate_of(instruments) == rate_of(sensors) && rate_of(instruments) != rate_of(own);
  };
  CHECK(readings_agree());
  world.teleport(id, {});
  other.teleport(with_own, {});
  CHECK(readings_agree());
  world.reset();
  other.reset();
  CHECK(readings_agree());

  std::vector<SensorSample> none;
  CHECK_THROWS_AS(world.read_sensors(id, none, 2), std::out_of_range);
  CHECK_THROWS_AS(world.reset_sensor(id, 0, {}, 2), std::out_of_range);
  world.remove_robot(id);
  CHECK_THROWS_AS(world.add_instruments(id, biased), std::out_of_range);
}
