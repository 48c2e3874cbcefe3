// A robot that is set in motion goes on from the first step as if it had always moved, with the commands on their way
// to the drives and without a blow to the sensors. Belts and flippers with prescribed motion follow it exactly. Their
// paths are checked against v t, friction's limits, mirror images and a course that is symmetric in time; the body
// ignores command and drives meanwhile, and wrong values are refused.
#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>

#include "tests/physics/scenes.hpp"

using namespace kenaf;
using namespace kenaf::physics;

namespace {

struct Robot {
  World world;
  RobotId id;
};

Robot settled(const RobotDescription& description, double friction = 1, double pitch_rad = 0) {
  World world(ground(friction, pitch_rad), {}, 1);
  const RobotId id = world.add_robot(description, "a", {{0, 0, 0.1}, rotation_from({0, pitch_rad, 0})});
  world.set_command(id, drive(0, 0));
  run(world, 0.5);
  return {std::move(world), id};
}

RobotMotion ahead(double speed_mps) {
  return {.v_WB_mps = {speed_mps, 0, 0}, .w_WB_radps = {0, 0, 0}, .track_mps = {speed_mps, speed_mps}};
}

PrescribedMotion belts(double left_mps, double right_mps) {
  return {.track_mps = {left_mps, right_mps}, .flipper_rad = {}};
}

// -1: none
std::ptrdiff_t first_difference(const std::vector<double>& a, const std::vector<double>& b) {
  const auto at = std::ranges::mismatch(a, b).in1;
  return at == a.end() ? -1 : at - a.begin();
}

double x_of(const Robot& robot) {
  return robot.world.truth(robot.id).X_WB.p.x();
}

}  // namespace

TEST_CASE("A robot that is set in motion goes on at that speed from the first step on") {
  Robot robot = settled(load_robot("kenaf"));
  const double start_m = x_of(robot);
  robot.world.set_in_motion(robot.id, ahead(0.3), drive(0.3, 0.3));
  CHECK(robot.world.truth(robot.id).v_WB_mps.x() == 0.3);
  CHECK(robot.world.truth(robot.id).track_mps[robot::kLeft] == 0.3);
  double least = 1, most = 0;
  for (int i = 0; i < 1000; ++i) {
    robot.world.step();
    const RobotTruth truth = robot.world.truth(robot.id);
    least = std::min({least, truth.v_WB_mps.x(), truth.track_mps[robot::kLeft], truth.track_mps[robot::kRight]});
    most = std::max({most, truth.v_WB_mps.x(), truth.track_mps[robot::kLeft], truth.track_mps[robot::kRight]});
  }
  // nothing brakes it: what is left is how the load moves between the contact points as belts begin to run
  CHECK(least > 0.299);
  CHECK(most < 0.301);
  CHECK(x_of(robot) - start_m == Approx(0.3).margin(3e-4));
}

TEST_CASE("Where body and belts do not fit, friction decides") {
  Robot robot = settled(plain_tracks(0.5));
  const double start_m = x_of(robot);
  RobotMotion motion = ahead(0.4);
  motion.track_mps = {0, 0};
  robot.world.set_in_motion(robot.id, motion, drive(0, 0));
  run(robot.world, 1);
  // v² / (2 mu g); a step is 0.4 mm
  CHECK(x_of(robot) - start_m == Approx(0.16 / (2 * 0.5 * kGravity)).margin(5e-4));
}

TEST_CASE("A command that is late, is scaled or ramps was on its way already") {
  RobotDescription description = load_robot("kenaf");
  description.effects.command_delay_s = 0.1;
  description.effects.command_gain = 0.8;
  description.effects.command_slew_s2pm = 2;  // 0.5 m/s²
  description.drive.time_constant_s = 0;
  Robot robot = settled(description);
  robot.world.set_in_motion(robot.id, ahead(0.24), drive(0.3, 0.3));  // 0.8 of 0.3
  const auto speed = [&robot] { return robot.world.truth(robot.id).track_mps[robot::kLeft]; };
  robot.world.set_command(robot.id, drive(0, 0));
  run(robot.world, 0.099);
  CHECK(speed() == Approx(0.24).margin(1e-3));
  run(robot.world, 0.001 + 0.2);  // then 0.2 s at 0.5 m/s²
  CHECK(speed() == Approx(0.14).margin(2e-3));
}

TEST_CASE("What a command asks for beyond the present speed, the drive still has to do") {
  Robot robot = settled(load_robot("kenaf"));
  robot.world.set_in_motion(robot.id, ahead(0.1), drive(0.4, 0.4));
  run(robot.world, 0.05);
  // a lag of 0.05 s from 0.1 to 0.4 m/s; the motor is far from its limit
  CHECK(robot.world.truth(robot.id).track_mps[robot::kRight] == Approx(0.4 - 0.3 * std::exp(-1)).margin(3e-3));
}

TEST_CASE("Sensors see a robot that moves, and no blow") {
  RobotDescription description = load_robot("kenaf");
  for (SensorDescription& sensor : description.sensors)
    sensor.noise_mps2 = sensor.noise_radps = sensor.bias_radps = sensor.noise_rad = 0;
  Robot robot = settled(description);
  robot.world.set_in_motion(robot.id, ahead(0.4), drive(0.4, 0.4));
  std::vector<SensorSample> samples;
  for (int i = 0; i < 20; ++i) {
    robot.world.read_sensors(robot.id, samples);
    robot.world.step();
  }
  int seen = 0;
  for (const SensorSample& sample : samples) {
    if (const auto* tachometer = std::get_if<TachometerReading>(&sample.reading))
      CHECK(tachometer->spin_radps[robot::kLeft] * description.drive.sprocket_radius_m == Approx(0.4).epsilon(5e-3));
    if (const auto* imu = std::get_if<ImuReading>(&sample.reading)) {
      CHECK(std::abs(imu->acceleration_mps2.x()) < 0.2);  // 0.4 m/s within a period of 0.01 s would be 40
      ++seen;
    }
  }
  CHECK(seen > 1);
}

TEST_CASE("A prescribed belt has exactly that speed after every step, whatever its motor") {
  RobotDescription weak = load_robot("kenaf");
  weak.drive.max_force_n = 0.1;
  weak.drive.max_speed_mps = 0.05;
  Robot robot = settled(weak, 1, -0.2);  // uphill
  for (int i = 0; i < 1000; ++i) {
    const double left_mps = 0.5 * std::sin(0.01 * i), right_mps = 0.3 * std::cos(0.02 * i);
    robot.world.prescribe(robot.id, belts(left_mps, right_mps));
    robot.world.step();
    REQUIRE(robot.world.truth(robot.id).track_mps == std::array{left_mps, right_mps});
  }
}

TEST_CASE("A robot on belts of speed v that moves so already comes v t far") {
  for (const double speed_mps : {0.3, -0.3, 1.5}) {
    Robot robot = settled(load_robot("kenaf"));
    const double start_m = x_of(robot);
    robot.world.set_in_motion(robot.id, ahead(speed_mps), drive(0, 0));
    robot.world.prescribe(robot.id, belts(speed_mps, speed_mps));
    run(robot.world, 2);
    CHECK(x_of(robot) - start_m == Approx(2 * speed_mps).margin(5e-4));
    CHECK(robot.world.truth(robot.id).track_m[robot::kLeft] == Approx(2 * speed_mps).margin(1e-9));
    CHECK(std::abs(yaw_of(robot.world.truth(robot.id).X_WB)) < 1e-4);
  }
}

TEST_CASE("From rest, friction takes the body along and no more") {
  Robot robot = settled(plain_tracks(0.5));
  const double start_m = x_of(robot);
  robot.world.prescribe(robot.id, belts(0.4, 0.4));
  run(robot.world, 1);
  // it slips for v / (mu g), in which it comes half as far as the belts
  CHECK(x_of(robot) - start_m == Approx(0.4 - 0.16 / (2 * 0.5 * kGravity)).margin(5e-4));
}

TEST_CASE("The faster left track turns it right, and mirrored belts drive the mirrored path") {
  const auto driven = [](double left_mps, double right_mps) {
    Robot robot = settled(load_robot("kenaf"));
    robot.world.prescribe(robot.id, belts(left_mps, right_mps));
    run(robot.world, 2);
    return robot.world.truth(robot.id).X_WB;
  };
  const Pose right = driven(0.3, 0.1), left = driven(0.1, 0.3), back_left = driven(-0.1, -0.3);
  CHECK(yaw_of(right) < -0.3);
  CHECK(right.p.y() < 0);
  CHECK(left.p.x() == Approx(right.p.x()).margin(1e-3));  // the order of contacts in the solver is not mirrored
  CHECK(left.p.y() == Approx(-right.p.y()).margin(1e-3));
  CHECK(yaw_of(left) == Approx(-yaw_of(right)).margin(2e-3));
  CHECK(back_left.p.x() < 0);
  CHECK(yaw_of(back_left) < -0.3);  // backwards, the faster right track turns it right
}

TEST_CASE("Belts that run back bring the robot back") {
  // symmetric in time: up, down, and the same with the other sign. Slow enough that mass plays no part: at 0.5 m/s²
  // the body lags behind friction's balance by v / (mu g) = 30 ms of what changes, the same on both ways.
  Robot robot = settled(load_robot("kenaf"));
  const Pose start = robot.world.truth(robot.id).X_WB;
  const auto ramp = [](double t_s) { return std::max(0.0, std::min(t_s, 1.2 - t_s)) * 0.5; };
  double furthest_m = 0;
  for (int i = 1; i <= 2400; ++i) {
    const double t_s = i * 0.001, speed = t_s <= 1.2 ? ramp(t_s) : -ramp(2.4 - t_s);
    robot.world.prescribe(robot.id, belts(speed, 0.4 * speed));
    robot.world.step();
    furthest_m = std::max(furthest_m, robot.world.truth(robot.id).X_WB.p.x());
  }
  const Pose end = robot.world.truth(robot.id).X_WB;
  CHECK(furthest_m > 0.1);
  CHECK((end.p - start.p).norm() < 2e-3);
  CHECK(std::abs(yaw_of(end) - yaw_of(start)) < 5e-3);
}

TEST_CASE("A prescribed belt says what force the ground asks of it") {
  const double slope = 0.2;
  Robot robot = settled(plain_tracks(1), 1, -slope);
  robot.world.prescribe(robot.id, belts(0.1, 0.1));
  run(robot.world, 1);
  double sum_n = 0;
  for (int i = 0; i < 1000; ++i) {
    robot.world.step();
    const RobotTruth truth = robot.world.truth(robot.id);
    sum_n += truth.track_force_n[robot::kLeft] + truth.track_force_n[robot::kRight];
  }
  const double weight_n = plain_tracks(1).total_mass_kg() * kGravity;
  CHECK(sum_n / 1000 == Approx(weight_n * std::sin(slope)).epsilon(0.01));
}

TEST_CASE("A drive that is let go follows its command from the speed at that moment") {
  Robot robot = settled(load_robot("kenaf"));
  robot.world.set_command(robot.id, drive(0, 0));
  robot.world.prescribe(robot.id, belts(0.3, 0.3));
  run(robot.world, 1);
  robot.world.prescribe(robot.id, {});
  run(robot.world, 0.05);
  CHECK(robot.world.truth(robot.id).track_mps[robot::kLeft] == Approx(0.3 * std::exp(-1)).margin(3e-3));
}

TEST_CASE("Prescribed flippers follow, under load and beyond what a servo can do") {
  RobotDescription description = load_robot("kenaf");
  description.servo.max_torque_nm = 0.1;
  description.servo.max_speed_radps = 0.1;
  Robot robot = settled(description);
  PrescribedMotion motion;
  double worst_rad = 0;
  for (int i = 1; i <= 2000; ++i) {
    const double angle = 1 - std::min(1.6, 0.001 * i);  // down to -0.6: it lifts the robot
    motion.flipper_rad.fill(angle);
    robot.world.prescribe(robot.id, motion);
    robot.world.step();
    const RobotTruth truth = robot.world.truth(robot.id);
    if (i < 200) continue;  // the weak servos had let the arms down: at 10 rad/s they come back
    for (const double is : truth.flipper_rad) worst_rad = std::max(worst_rad, std::abs(is - angle));
    CHECK(truth.servo_rad[robot::kFrontLeft] == Approx(truth.flipper_rad[robot::kFrontLeft]).margin(1e-3));
  }
  CHECK(worst_rad < 1e-4);  // what ten iterations leave in a joint that takes up the robot's weight
  CHECK(robot.world.truth(robot.id).X_WB.p.z() > 0.1);  // from 0.09
}

// The encoder sits at the servo: what it measured says nothing of the play and the give behind it, so they stay.
TEST_CASE(
    "The servo of a prescribed flipper is where it is commanded, and the arm gives way as under any other torque") {
  constexpr double kGive_radpnm = 0.02, kPlay_rad = 0.04;
  for (const double play_rad : {0.0, kPlay_rad}) {
    RobotDescription description = load_robot("kenaf");
    description.effects.flipper_compliance_radpnm = kGive_radpnm;
    description.effects.flipper_backlash_rad = play_rad;
    Robot robot = settled(description);
    PrescribedMotion motion;
    for (int i = 1; i <= 3000; ++i) {
      // down to -0.6: it lifts the robot, and stands so for 1.4 s
      motion.flipper_rad.fill(1 - std::min(1.6, 0.001 * i));
      robot.world.prescribe(robot.id, motion);
      robot.world.step();
    }
    const RobotTruth truth = robot.world.truth(robot.id);
    const DriveCurrents currents = robot.world.drive_currents(robot.id);
    INFO("play " << play_rad);
    for (std::size_t i = 0; i < robot::kFlipperCount; ++i) {
      const double torque_nm = currents.flipper_a[i] / description.servo.amperes_per_nm;
      CHECK(torque_nm > 1);  // a part of the robot's weight
      CHECK(truth.servo_rad[i] == Approx(-0.6).margin(1e-9));
      // spring behind the play, pressed up by the ground
      CHECK(truth.flipper_rad[i] == Approx(-0.6 + play_rad / 2 + kGive_radpnm * torque_nm).margin(2e-3));
    }
  }
}

TEST_CASE("With belts and flippers prescribed, command and drives change no bit of what the body does", "[long]") {
  const auto path = [](const RobotDescription& description, const robot::Command& command) {
    World world(ground(), {}, 1);
    const RobotId id = world.add_robot(description, "a", {});
    Robot robot{std::move(world), id};
    std::vector<double> numbers;
    PrescribedMotion motion;
    for (int i = 0; i < 1500; ++i) {
      motion.track_mps = {0.4 * std::sin(0.004 * i), 0.3 * std::sin(0.005 * i)};
      motion.flipper_rad.fill(1 - 0.0008 * i);
      robot.world.set_command(robot.id, command);
      robot.world.prescribe(robot.id, motion);
      robot.world.step();
      const RobotTruth truth = robot.world.truth(robot.id);
      for (Eigen::Index k = 0; k < 3; ++k) numbers.push_back(truth.X_WB.p[k]);
      for (Eigen::Index k = 0; k < 4; ++k) numbers.push_back(truth.X_WB.q.coeffs()[k]);
    }
    return numbers;
  };
  const RobotDescription nominal = load_robot("kenaf");
  const std::vector<double> expected = path(nominal, drive(0, 0));
  CHECK(first_difference(path(nominal, drive(0.5, -0.5, 0.3, -0.3)), expected) == -1);
  for (const char* effect :
       {"command_delay:delay_s=0.2", "command_loss:probability=0.5", "command_gain:gain=0.7", "drive_lag:lag_s=0.3",
        "drive_asymmetry:ratio=0.2", "drive_torque_limit:scale=0.2", "drive_coulomb:force_n=30",
        "drive_viscous:damping_nspm=50", "battery_sag:resistance_ohm=0.5", "flipper_lag:lag_s=0.2"}) {
    INFO(effect);
    RobotDescription changed = nominal;
    set_effect(changed.effects, effect);
    CHECK(first_difference(path(changed, drive(0.2, 0.2)), expected) == -1);
  }
}

TEST_CASE("What is no speed is refused, a teleport ends what was prescribed") {
  Robot robot = settled(load_robot("kenaf"));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(robot.world.set_in_motion(robot.id, ahead(nan), drive(0, 0)), std::invalid_argument);
  CHECK_THROWS_AS(robot.world.set_in_motion(robot.id, ahead(0.1), drive(nan, 0)), std::invalid_argument);
  CHECK_THROWS_AS(robot.world.set_in_motion(robot.id, ahead(0.1), drive(0, 0, nan)), std::invalid_argument);
  CHECK_THROWS_AS(robot.world.prescribe(robot.id, belts(nan, 0)), std::invalid_argument);
  robot.world.prescribe(robot.id, belts(0.3, 0.3));
  run(robot.world, 0.1);
  robot.world.teleport(robot.id, {{1, 0, 0.1}, Eigen::Quaterniond::Identity()});
  run(robot.world, 1);
  CHECK(robot.world.truth(robot.id).track_mps[robot::kLeft] == Approx(0).margin(1e-6));
  CHECK(x_of(robot) == Approx(1).margin(1e-3));
}
