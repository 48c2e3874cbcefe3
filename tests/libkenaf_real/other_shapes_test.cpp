// Robots without flippers, with two, with several drives on a side; and other devices on the bus, which are left alone.
//
// 1. Flippers that the robot has not are commanded in vain: no error, nothing moves; those it has obey.
// 2. Several drives of a side get one speed; travel and speed are the mean of theirs, the current is their sum.
// 3. Drives and sensors that the description does not name get no frame of their own, are not waited for, and stay as
//    they were; what they send changes nothing.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>

#include "can/canbus/bus_layout.hpp"
#include "hrt/error.hpp"
#include "robot/state.hpp"
#include "tests/libkenaf_real/changed_robot.hpp"
#include "tests/libkenaf_real/robot_on_bus.hpp"

using namespace kenaf;
using namespace kenaf::real;
using candrives::Sender;
using canopen::PowerState;

namespace {

// Kenaf with front flippers alone.
ChangedRobot with_front_flippers() {
  return ChangedRobot({{"rear_left = { node = 5, direction = -1, zero_counts = 0 }\n", ""},
                       {"rear_right = { node = 6, direction = 1, zero_counts = 0 }\n", ""},
                       {"\n[flipper]\n", "\n[flipper]\npairs = \"front\"\n"}});
}

// Kenaf with two motors on each track.
ChangedRobot with_two_motors_a_side() {
  return ChangedRobot({{"left = { node = 1, direction = 1 }",
                        "left = [{ node = 1, direction = 1 }, { node = 9, "
                        "direction = -1 }]"},
                       {"right = { node = 2, direction = -1 }",
                        "right = [{ node = 2, direction = -1 }, { node = 10, direction = 1 }]"}});
}

}  // namespace

TEST_CASE("A robot without flippers takes commands to flippers, and has none") {
  RobotOnBus robot("marmotte");
  robot.open();
  robot::Command command = drive_at(0.1, 0.1);
  command.flipper.fill({robot::JointMode::angle, 1.0});
  const robot::State state = robot.run(50, command);
  CHECK((state.fields & robot::kHasFlippers) == 0);
  CHECK(state.flipper_rad == std::array<double, 4>{});
  CHECK(state.track_mps[0] == Approx(0.1).margin(1e-3));
}

TEST_CASE("A robot with front flippers moves them, and reports no rear ones") {
  const ChangedRobot front = with_front_flippers();
  RobotOnBus robot(front.path());
  robot.open();
  REQUIRE(robot.description.drives.size() == 4);
  robot::Command command;
  command.flipper.fill({robot::JointMode::angle, 0.5});
  const robot::State state = robot.run(150, command);
  CHECK((state.fields & robot::kHasFlippers) != 0);
  CHECK(state.flipper_rad[robot::kFrontLeft] == Approx(0.5).margin(1e-3));
  CHECK(state.flipper_rad[robot::kFrontRight] == Approx(0.5).margin(1e-3));
  CHECK(std::isnan(state.flipper_rad[robot::kRearLeft]));
  CHECK(std::isnan(state.flipper_rad[robot::kRearRight]));
  CHECK(robot.plant.state().flipper_rad == std::array<double, 4>{state.flipper_rad[0], state.flipper_rad[1], 0, 0});
  robot.transport.close();
  CHECK(robot.all_are(PowerState::quick_stop_active));
}

TEST_CASE("Drives of one side are told one speed, each in its own direction") {
  const ChangedRobot two = with_two_motors_a_side();
  RobotOnBus robot(two.path());
  robot.open();
  REQUIRE(robot.description.drives.size() == 8);
  std::map<std::uint16_t, std::int32_t> target;
  robot.wire.alter = [&](canopen::Frame& frame, Sender sender) {
    if (sender == Sender::master && frame.id > 0x200 && frame.id <= 0x27f)
      target[frame.id] = canopen::get_signed(frame.data, 2, 4);
    return true;
  };
  robot.run(100, drive_at(0.2, -0.1));
  const std::int32_t left = velocity_to_drive(robot.description.drives.front().units, 0.2);
  CHECK(target.at(0x201) == left);
  CHECK(target.at(0x209) == -left);
  CHECK(target.at(0x202) == -target.at(0x20a));
  CHECK(robot.plant.state().track_mps[robot::kLeft] == Approx(0.2).margin(1e-4));
  CHECK(robot.plant.state().track_mps[robot::kRight] == Approx(-0.1).margin(1e-4));
}

TEST_CASE("A side's travel and speed are the mean of its drives'") {
  const ChangedRobot two = with_two_motors_a_side();
  RobotOnBus robot(two.path());
  robot.open();
  const double counts_per_m = std::abs(robot.description.drives.front().units.counts_per_unit);
  const robot::State before = robot.run(3, robot::Command{});
  // as if the second left motor went 0.1 m forward, 2 mm a cycle, which its direction makes negative
  double gone_m = 0;
  robot.wire.alter = [&](canopen::Frame& frame, Sender sender) {
    if (sender != Sender::slaves) return true;
    const auto add = [&](std::size_t at, double m) {
      const auto shifted = canopen::get_signed(frame.data, at, 4) - std::lround(m * counts_per_m);
      canopen::put(frame.data, at, 4, static_cast<std::uint32_t>(shifted));
    };
    if (frame.id == 0x189) {
      gone_m = std::min(gone_m + 0.002, 0.1);
      add(2, gone_m);
    }
    if (frame.id == 0x289) add(0, 0.2);
    return true;
  };
  const robot::State after = robot.run(60, robot::Command{});
  CHECK(after.track_m[robot::kLeft] - before.track_m[robot::kLeft] == Approx(0.05).margin(1e-5));
  CHECK(after.track_mps[robot::kLeft] == Approx(0.1).margin(1e-4));
  CHECK(after.track_m[robot::kRight] == before.track_m[robot::kRight]);
  CHECK(after.track_mps[robot::kRight] == 0);
}

TEST_CASE("A drive of several on a side that falls silent is named, and all stop") {
  const ChangedRobot two = with_two_motors_a_side();
  RobotOnBus robot(two.path());
  robot.open();
  robot.run(30, drive_at(0.2, 0.2));
  robot.wire.inject({candrives::FaultKind::silent, 9});
  try {
    robot.run(20, drive_at(0.2, 0.2));
    FAIL("it drives on");
  } catch (const hrt::Error& error) {
    CHECK(error.code() == HRT_E_DEVICE);
    CHECK_THAT(error.what(), Catch::StartsWith("track left 2 (node 9) has been silent for"));
  }
  CHECK(robot.seconds_to_rest() < 0.2);
}

TEST_CASE("Devices that the description does not name are left alone") {
  // Two tracks are the robot's. An arm of somebody else has four drives on the same bus: nodes 3 to 6.
  canbus::RobotBus all = canbus::load_robot_bus("marmotte");
  for (const canbus::DriveOnBus& drive : canbus::load_robot_bus("kenaf").drives) {
    if (drive.is_flipper()) all.drives.push_back(drive);
  }
  RobotOnBus robot("marmotte", all);
  robot.config.track_gauge_mm = 520;
  REQUIRE(robot.description.drives.size() == 2);

  // Their own master has set them to work: heartbeats, operational, node 3 enabled by SDO.
  const auto tell = [&](std::uint16_t id, std::vector<std::uint8_t> data) {
    robot.wire.send_as_other(canopen::make_frame(id, data));
    robot.wire.run_until(robot.wire.now() + std::chrono::milliseconds(3));
  };
  for (std::uint8_t node = 3; node <= 6; ++node) {
    tell(static_cast<std::uint16_t>(0x600 + node), {0x2b, 0x17, 0x10, 0, 100, 0, 0, 0});  // 0x1017: each 100 ms
    tell(canopen::kNmtCommandId, {1, node});
  }
  for (const std::uint8_t word : std::array<std::uint8_t, 3>{0x06, 0x07, 0x0f})
    tell(0x603, {0x2b, 0x40, 0x60, 0, word, 0, 0, 0});
  REQUIRE(robot.power(2) == PowerState::operation_enabled);
  const std::size_t before = robot.wire.log().size();

  robot.open();
  robot.run(30, drive_at(0.2, 0.2));
  // Their errors, restarts and silence are not the robot's; nor is what a battery monitor sends, node 20.
  robot.wire.inject({candrives::FaultKind::error, 4, 0x2310});
  robot.wire.inject({candrives::FaultKind::power_loss, 5});
  robot.wire.inject({candrives::FaultKind::silent, 6});
  robot.wire.send_as_other(canopen::make_frame(0x714, std::vector<std::uint8_t>{0}));
  robot.wire.send_as_other(canopen::make_frame(0x094, std::vector<std::uint8_t>{0x10, 0x31, 1, 0, 0, 0, 0, 0}));
  robot.wire.send_as_other(canopen::make_frame(0x194, std::vector<std::uint8_t>{0x18, 0, 0, 0, 0, 0}));
  const robot::State state = robot.run(100, drive_at(0.2, 0.2));
  CHECK(state.track_mps[0] == Approx(0.2).margin(1e-3));
  CHECK(state.late_commands == 0);
  CHECK(robot.transport.warning().empty());
  robot.transport.close();

  // The library has sent frames to its own nodes, its heartbeat, and SYNC.
  const auto is_own = [](unsigned node) { return node == 1 || node == 2 || node == 7 || node == 8; };
  for (std::size_t i = before; i < robot.wire.log().size(); ++i) {
    const candrives::LoggedFrame& one = robot.wire.log()[i];
    if (one.sender != Sender::master || is_sync(one.frame) || one.frame.id == 0x77f) continue;
    CAPTURE(one.frame.id, int{one.frame.data[1]});
    CHECK(is_own(one.frame.id == canopen::kNmtCommandId ? one.frame.data[1] : one.frame.id & 0x7fu));
  }
  CHECK(robot.power(2) == PowerState::operation_enabled);
}
