// The robot on its bus, from hrt's side: boot, motion, posture, end. Time is the bus's; drives and plant are the
// simulated ones.
#include "tests/libkenaf_real/robot_on_bus.hpp"
#include "robot/state.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <utility>

#include "hrt/error.hpp"
#include "libkenaf_real/bus_cycle.hpp"
#include "tests/libkenaf_real/changed_robot.hpp"

using namespace kenaf;
using namespace kenaf::real;
using canopen::PowerState;

TEST_CASE("Opening enables all drives and moves nothing") {
  RobotOnBus robot;
  robot.open();
  CHECK(robot.all_are(PowerState::operation_enabled));
  CHECK(robot.plant.state().track_m == std::array<double, 2>{});
  CHECK(robot.plant.state().flipper_rad == std::array<double, 4>{});
  const robot::State state = robot.run(1, robot::Command{});
  CHECK(state.frame == 1);  // those of power-up are not the program's
  CHECK((state.fields &
         (robot::kHasPosture | robot::kHasEncoders | robot::kHasFlippers | robot::kHasCurrents | robot::kHasBattery)) ==
        (robot::kHasPosture | robot::kHasEncoders | robot::kHasFlippers | robot::kHasCurrents | robot::kHasBattery));
  CHECK(state.battery_v == Approx(25.9));
  CHECK(robot.transport.warning().empty());
}

TEST_CASE("Both tracks forward are forward, and as far as their ramp lets them") {
  RobotOnBus robot;
  robot.open();
  const robot::State before = robot.run(1, drive_at(0.2, 0.2));
  const robot::State after = robot.run(101, drive_at(0.2, 0.2));
  // The command reaches the drives with the SYNC after it, and what that SYNC latches is from before: 1.00 s at 0.2
  // m/s, less 0.2 m/s / 5 m/s^2 * 0.2 m/s / 2 for the ramp, plus or minus the 1 ms of the drives' own step.
  const double way_m = 0.2 * 1.0 - 0.2 * 0.2 / (2 * 5);
  for (const std::size_t t : {robot::kLeft, robot::kRight}) {
    CHECK(after.track_m[t] - before.track_m[t] == Approx(way_m).margin(0.0003));
    CHECK(after.track_mps[t] == Approx(0.2).margin(1e-4));
    CHECK(robot.plant.state().track_m[t] > 0);
  }
  CHECK(after.frame == before.frame + 101);
  CHECK(after.robot_time_s - before.robot_time_s == Approx(1.01));
  CHECK(after.late_commands == 0);
}

TEST_CASE("A flipper goes to its angle in the time of its trapezoid, the others stay") {
  RobotOnBus robot;
  robot.open();
  robot::Command command;
  command.flipper[robot::kRearLeft] = {robot::JointMode::angle, 1.0};
  // 1 rad at 1.5 rad/s and 15 rad/s^2: 0.85 / 1.5 + 2 * 0.1 = 0.767 s; the command takes three cycles until the drive
  // has it
  robot::State state = robot.run(60, command);
  CHECK(state.flipper_rad[robot::kRearLeft] < 0.95);
  state = robot.run(25, command);
  CHECK(state.flipper_rad[robot::kRearLeft] == Approx(1.0).margin(1e-3));
  CHECK(robot.plant.state().flipper_rad[robot::kRearLeft] == Approx(1.0).margin(1e-3));
  for (const std::size_t f : {robot::kFrontLeft, robot::kFrontRight, robot::kRearRight})
    CHECK(state.flipper_rad[f] == 0);
  // a newer target replaces one under way
  command.flipper[robot::kRearLeft].value = -1.0;
  robot.run(20, command);
  command.flipper[robot::kRearLeft].value = 0.5;
  state = robot.run(150, command);
  CHECK(state.flipper_rad[robot::kRearLeft] == Approx(0.5).margin(1e-3));
}

TEST_CASE("Roll, pitch and yaw have the robot's signs") {
  RobotOnBus robot;
  robot.open();
  robot.plant.roll_rad = 0.1;    // left side up
  robot.plant.pitch_rad = -0.2;  // nose up
  robot::State state = robot.run(2, robot::Command{});
  CHECK(state.posture_rad[0] == Approx(0.1).margin(1e-4));  // 0.01 degrees of resolution
  CHECK(state.posture_rad[1] == Approx(-0.2).margin(1e-4));
  robot.plant.roll_rad = robot.plant.pitch_rad = 0;
  robot.plant.yaw_rate_radps = 0.5;  // to the left
  const double before_rad = robot.run(2, drive_at(-0.1, 0.1)).posture_rad[2];
  state = robot.run(100, drive_at(-0.1, 0.1));
  CHECK(state.posture_rad[2] - before_rad == Approx(0.5).margin(0.01));
}

TEST_CASE("A turn that is too slow for the encoders to be seen as one is no bias of the gyro") {
  RobotOnBus robot;
  robot.open();
  // 1 mm/s at a gauge of 0.2 m: 0.01 rad/s; what was measured in the first two cycles is from before
  const robot::Command slowly = drive_at(-0.001, 0.001);
  robot.run(2, slowly);
  robot.plant.yaw_rate_radps = 0.01;
  const double before_rad = robot.run(2, slowly).posture_rad[2];
  const robot::State state = robot.run(1000, slowly);
  CHECK(std::abs(state.track_mps[0]) < 0.002);
  CHECK(state.posture_rad[2] - before_rad == Approx(0.1).margin(0.004));  // a unit of the gyro in 10 s: 0.003 rad
}

TEST_CASE("Travel goes on where a drive's counter wraps") {
  RobotOnBus robot;
  robot.open();
  // 2^31 counts are 5.9 km: the wrap is made by letting the counter start just below it
  bool shifted = false;
  robot.wire.alter = [&](canopen::Frame& frame, candrives::Sender) {
    if (shifted && frame.id == 0x181)
      canopen::put(frame.data, 2, 4, canopen::get_unsigned(frame.data, 2, 4) + 0x7fff0000u);
    return true;
  };
  robot.transport.close();
  shifted = true;
  robot.open();
  robot.run(1, drive_at(0.2, 0.2));
  const robot::State state = robot.run(200, drive_at(0.2, 0.2));
  CHECK(state.track_m[0] == Approx(state.track_m[1]).margin(1e-4));
  CHECK(state.track_m[0] == Approx(0.2 * 1.98 - 0.004).margin(0.003));
}

TEST_CASE("Closing stops the tracks, holds the flippers, and leaves no drive in fault") {
  RobotOnBus robot;
  robot.open();
  robot.run(50, drive_at(0.3, -0.3));
  robot.transport.close();
  CHECK(robot.stands());
  CHECK(robot.all_are(PowerState::quick_stop_active));
  robot.wire.run_until(robot.wire.now() + std::chrono::seconds(2));
  CHECK(robot.all_are(PowerState::quick_stop_active));
  // and it opens again, without a jump
  const auto at_rest = robot.plant.state().track_m;
  robot.open();
  CHECK(robot.plant.state().track_m == at_rest);
  CHECK(robot.all_are(PowerState::operation_enabled));
}

TEST_CASE("A bus that has a master already is refused") {
  RobotOnBus robot;
  robot.open();
  CanTransport second(
      [&](const std::string&, std::span<const std::uint16_t>) { return std::make_unique<BorrowedBus>(robot.wire); });
  try {
    // the first one's heartbeats and SYNC are on the bus; nothing the second one does is
    second.open(robot.config);
    FAIL("there are two masters");
  } catch (const hrt::Error& error) {
    CHECK(error.code() == HRT_E_REFUSED);
    CHECK_THAT(error.what(), Catch::Contains("another program controls the robot"));
  }
}

TEST_CASE("An interrupt ends the wait for a state") {
  RobotOnBus robot;
  robot.open();
  robot.run(3, robot::Command{});
  robot.transport.interrupt();
  CHECK_FALSE(robot.transport.wait_state());
}

TEST_CASE("A robot with cyclic modes drives the same way, on the master's ramps") {
  const ChangedRobot cyclic({{"profile velocity", "cyclic velocity"}, {"profile position", "cyclic position"}});
  RobotOnBus robot(cyclic.path());
  robot.open();
  const robot::State before = robot.run(1, robot::Command{});
  robot::Command command = drive_at(0.2, 0.2);
  command.flipper[robot::kFrontRight] = {robot::JointMode::angle, -0.8};
  const robot::State after = robot.run(101, command);
  // The ramp goes in steps of 0.05 m/s a cycle: 0.05, 0.10, 0.15, 0.2 m/s. In 1.00 s: 0.2 - (0.15 + 0.10 + 0.05) * 0.01
  // = 0.197 m
  CHECK(after.track_m[0] - before.track_m[0] == Approx(0.197).margin(0.0025));
  CHECK(after.track_m[0] == Approx(after.track_m[1]));
  CHECK(after.flipper_rad[robot::kFrontRight] == Approx(-0.8).margin(2e-3));
  CHECK(after.flipper_rad[robot::kFrontLeft] == 0);
}

TEST_CASE("Flippers without absolute encoders are homed where they stand, or at their switch") {
  const ChangedRobot here({{"\n[can.inclinometer]", std::string(kHomeHere) + "\n[can.inclinometer]"}});
  RobotOnBus robot(here.path());
  robot.open();
  // the arm stood at what the description calls 0.7 rad, wherever the encoder began
  const robot::State state = robot.run(2, robot::Command{});
  for (const double angle_rad : state.flipper_rad) CHECK(angle_rad == Approx(0.7).margin(1e-3));
  robot::Command command;
  command.flipper.fill({robot::JointMode::angle, 0.2});
  CHECK(robot.run(150, command).flipper_rad[robot::kFrontLeft] == Approx(0.2).margin(1e-3));
}

TEST_CASE("A program that answers too late is told so, cycle by cycle") {
  RobotOnBus robot;
  robot.open();
  robot.run(5, robot::Command{});
  (void)robot.transport.wait_state();
  robot.wire.run_until(robot.wire.now() + std::chrono::milliseconds(25));  // two SYNCs went by
  robot.transport.send(robot::Command{});
  const robot::State state = robot.run(2, robot::Command{});
  CHECK(state.late_commands == 1);
}

TEST_CASE("What was late while the robot was opened is not counted as the program's") {
  RobotOnBus robot;
  bool was_held_up = false;  // with its first orders: two SYNCs go by
  robot.wire.alter = [&](canopen::Frame& frame, candrives::Sender sender) {
    if (sender == candrives::Sender::master && frame.id == 0x201 && !std::exchange(was_held_up, true))
      robot.wire.run_until(robot.wire.now() + std::chrono::milliseconds(25));
    return true;
  };
  robot.open();
  CHECK(was_held_up);
  CHECK(robot.run(2, robot::Command{}).late_commands == 0);
}

TEST_CASE("A SYNC that stops is a link that is lost") {
  RobotOnBus robot;
  robot.open();
  robot.run(5, robot::Command{});
  robot.wire.stop_sync();
  try {
    robot.run(20, robot::Command{});
    FAIL("it went on without SYNC");
  } catch (const hrt::Error& error) {
    CHECK(error.code() == HRT_E_LINK);
    CHECK_THAT(error.what(), Catch::Contains("no SYNC on can0"));
  }
}

TEST_CASE("A track_gauge_mm that is not the described robot's is warned of") {
  // the shipped robot's tracks are 0.2 m apart, which is the default
  for (const auto& [gauge_mm, says] : {std::pair{205.0, ""}, {250.0, "track_gauge_mm is 250"}}) {
    RobotOnBus robot;
    robot.config.track_gauge_mm = gauge_mm;
    robot.open();
    robot.run(2, robot::Command{});
    CHECK_THAT(robot.transport.warning(), Catch::StartsWith(says));
    CHECK(robot.transport.warning().empty() == (std::string(says) == ""));
    if (robot.transport.warning().empty()) continue;
    CHECK_THAT(robot.transport.warning(), Catch::Contains("200 mm"));
    robot.wire.inject({candrives::FaultKind::silent, 7});
    robot.run(15, robot::Command{});
    CHECK_THAT(robot.transport.warning(),
               Catch::StartsWith("inclinometer (node 7) is silent") && Catch::Contains("track_gauge_mm is 250"));
  }
}

TEST_CASE("A gyro that turns while the robot stands, too fast for a bias, is warned of") {
  for (const auto& [rate_radps, says] : {std::pair{0.04, ""}, {-0.08, "gyro (node 8) measured -0.08 rad/s while"}}) {
    RobotOnBus robot;
    robot.plant.yaw_rate_radps = rate_radps;
    robot.open();
    CHECK_THAT(robot.transport.warning(), Catch::StartsWith(says));
    CHECK(robot.transport.warning().empty() == (std::string(says) == ""));
    robot.wire.inject({candrives::FaultKind::silent, 7});
    robot.run(15, robot::Command{});
    CHECK_THAT(robot.transport.warning(),
               Catch::StartsWith("inclinometer (node 7) is silent") && Catch::Contains(says));
  }
}

TEST_CASE("A period that the bus cannot carry, or that is too long to notice a drive's silence in time, is refused") {
  struct Case {
    double period_s;
    const char* says;
  };
  // By tests/can/canbus/bus_layout_test.cpp a cycle has 1964.5 bits, the heartbeats 8450 a second: 395 kbit/s at 0.0051
  // s, of which 350 (70 % of 500) are allowed; at 0.0058 s it is 347.
  for (const Case& one : {Case{0.001, "can.bit_rate"}, Case{0.0051, "79 % of"}, Case{0.1, "0.02"}}) {
    RobotOnBus robot;
    robot.config.period_s = one.period_s;
    try {
      robot.open();
      FAIL("it opened");
    } catch (const hrt::Error& error) {
      CHECK(error.code() == HRT_E_CONFIG);
      CHECK_THAT(error.what(), Catch::Contains("period_s") && Catch::Contains(one.says));
    }
    CHECK(robot.wire.log().empty());  // nothing was sent
  }
  for (const double period_s : {0.0058, 0.02}) {
    RobotOnBus robot;
    robot.config.period_s = period_s;
    robot.open();
    CHECK(robot.run(10, robot::Command{}).late_commands == 0);
  }
}

TEST_CASE("A bus of twice the bit rate takes a shorter period") {
  canbus::RobotBus bus = canbus::load_robot_bus("kenaf");
  // 1964.5 bits / 0.004 s + 8450 a second: 500 kbit/s
  CHECK_THROWS_AS(check_period(bus, 0.004), hrt::Error);
  bus.bit_rate = 1'000'000;
  CHECK_NOTHROW(check_period(bus, 0.004));
}
