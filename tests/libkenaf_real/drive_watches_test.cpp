// The two watches of a drive, each without the other: which of them it has, what hrt is told of it, and that one alone
// stops it.
//
// Numbers by hand, for the shipped robot: both watches wait for 0.1 s, from the last heartbeat (each 20 ms) and from
// the last command (each 10 ms); then 16 ms from 0.2 m/s at 12.5 m/s^2.
#include <catch2/catch.hpp>

#include "hrt/error.hpp"
#include "libkenaf_real/drive_watches.hpp"
#include "tests/libkenaf_real/changed_robot.hpp"
#include "tests/libkenaf_real/robot_on_bus.hpp"

using namespace kenaf;
using namespace kenaf::real;
using candrives::FaultKind;
using canopen::PowerState;

namespace {

constexpr double kRamp_s = 0.2 / 12.5;
constexpr std::uint32_t kObjectMissing = 0x06020000, kSubIndexMissing = 0x06090011, kUnsupportedAccess = 0x06010000;

ChangedRobot kenaf_with(const std::string& keys) {
  return ChangedRobot({{"interface = \"can0\"", "interface = \"can0\"\n" + keys}});
}

// `node` answers each SDO request for this object by an abort.
void refuse(RobotOnBus& robot, canopen::NodeId node, std::uint32_t index_and_sub, std::uint32_t code) {
  robot.wire.alter = [=, before = robot.wire.alter](canopen::Frame& frame, candrives::Sender sender) {
    if (frame.id == 0x580 + node && canopen::get_unsigned(frame.data, 1, 2) == index_and_sub >> 8 &&
        frame.data[3] == (index_and_sub & 0xff)) {
      frame.data[0] = 0x80;
      canopen::put(frame.data, 4, 4, code);
    }
    return !before || before(frame, sender);
  };
}

std::string refusal_of(RobotOnBus& robot) {
  try {
    robot.open();
  } catch (const hrt::Error& error) {
    CHECK(error.code() == HRT_E_DEVICE);
    return error.what();
  }
  return {};
}

}  // namespace

TEST_CASE("Each watch alone stops the robot when its master dies") {
  struct Case {
    FaultKind without;
    double shortest_s, longest_s;  // from the last heartbeat or command before the death to the end of the watch
  };
  for (const Case& one : {Case{FaultKind::no_heartbeat, 0.09, 0.1}, Case{FaultKind::no_event_timer, 0.08, 0.1}}) {
    for (int cycles = 30; cycles < 34; ++cycles) {
      RobotOnBus robot;
      robot.open();
      robot.run(cycles, drive_at(0.2, 0.2));
      robot.wire.inject({one.without, 0});
      robot.wire.stop_master();
      const double rest_s = robot.seconds_to_rest();
      CAPTURE(cycles, rest_s);
      CHECK(rest_s >= one.shortest_s + kRamp_s - 0.001);
      CHECK(rest_s <= one.longest_s + kRamp_s + 0.002);
      CHECK(robot.all_are(PowerState::quick_stop_active));
    }
  }
}

TEST_CASE("Without either watch the robot would drive on: the faults are what the test above takes them for") {
  RobotOnBus robot;
  robot.open();
  robot.run(30, drive_at(0.2, 0.2));
  robot.wire.inject({FaultKind::no_heartbeat, 0});
  robot.wire.inject({FaultKind::no_event_timer, 0});
  robot.wire.stop_master();
  CHECK(robot.seconds_to_rest() >= 1);
}

TEST_CASE("Opening says of each drive which watches it has") {
  RobotOnBus both;
  both.open();
  const std::string setup = both.transport.setup();
  CHECK_THAT(setup, Catch::StartsWith("track left (node 1) watches its master's heartbeat (0x1016, 0.1 s) and its "
                                      "commands (0x1400:05, 0.1 s)\ntrack right (node 2) watches"));
  CHECK(std::ranges::count(setup, '\n') == 6);
  CHECK(both.transport.warning().empty());

  SECTION("a drive without an event timer works, with a warning") {
    RobotOnBus robot;
    refuse(robot, 5, 0x140005, kSubIndexMissing);
    robot.open();
    CHECK_THAT(robot.transport.setup(),
               Catch::Contains("flipper rear left (node 5) watches its master's heartbeat (0x1016, "
                               "0.1 s) alone"));
    CHECK_THAT(robot.transport.warning(), Catch::Contains("no watch of commands (0x1400:05)") &&
                                              Catch::Contains("heartbeat: flipper rear left (node 5); ") &&
                                              Catch::Contains("`event_timer = false` in [can]"));
  }
  SECTION("a drive without a watch of the heartbeat works, with a warning") {
    RobotOnBus robot;
    refuse(robot, 2, 0x101601, kObjectMissing);
    robot.open();
    CHECK_THAT(robot.transport.setup(),
               Catch::Contains("track right (node 2) watches its commands (0x1400:05, 0.1 s) alone"));
    CHECK_THAT(robot.transport.warning(),
               Catch::Contains("no watch of the master's heartbeat (0x1016), only of commands: track right (node 2)"));
    robot.run(20, drive_at(0.2, 0.2));
    CHECK_NOTHROW(robot.transport.close());
  }
  SECTION("a drive without either is refused before anything is enabled") {
    RobotOnBus robot;
    refuse(robot, 2, 0x101601, kObjectMissing);
    refuse(robot, 2, 0x140005, kSubIndexMissing);
    CHECK_THAT(refusal_of(robot), Catch::Contains("track right (node 2) watches neither") &&
                                      Catch::Contains("(0x1400:05): nothing would stop it") &&
                                      Catch::Contains("`error_control = \"node guarding\"` in a device file"));
    CHECK(robot.all_are(PowerState::switch_on_disabled));
  }
  SECTION("nor is one driven whose commands the description does not let it watch, and that has nothing else") {
    const ChangedRobot without = kenaf_with("event_timer = false");
    RobotOnBus robot(without.path(), canbus::load_robot_bus("kenaf"));
    refuse(robot, 2, 0x101601, kObjectMissing);
    CHECK_THAT(refusal_of(robot), Catch::Contains("track right (node 2) watches neither") &&
                                      Catch::Contains("(0x1400:05, `event_timer = false` in [can])"));
    CHECK(robot.all_are(PowerState::switch_on_disabled));
  }
  SECTION("event_timer = false: known, and no warning") {
    const ChangedRobot without = kenaf_with("event_timer = false");
    RobotOnBus robot(without.path());  // its simulated drives have none
    robot.open();
    CHECK_THAT(robot.transport.setup(),
               Catch::Contains("track left (node 1) watches its master's heartbeat (0x1016, 0.1 s) "
                               "alone"));
    CHECK(robot.transport.warning().empty());
  }
  SECTION("event_timer = true: a drive without one is refused") {
    const ChangedRobot required = kenaf_with("event_timer = true");
    RobotOnBus robot(required.path());
    refuse(robot, 5, 0x140005, kSubIndexMissing);
    CHECK_THAT(refusal_of(robot),
               Catch::Contains("flipper rear left (node 5)") && Catch::Contains("`event_timer = true` in [can]"));
  }
}

TEST_CASE("An event timer that is written only while its PDO is invalid is written so") {
  RobotOnBus robot;
  bool valid = true;
  robot.wire.alter = [&](canopen::Frame& frame, candrives::Sender sender) {
    const bool of_identifier = canopen::get_unsigned(frame.data, 1, 3) == 0x011400;
    if (sender == candrives::Sender::master && frame.id == 0x603 && of_identifier) valid = (frame.data[7] & 0x80) == 0;
    if (frame.id == 0x583 && frame.data[0] == 0x60 && canopen::get_unsigned(frame.data, 1, 3) == 0x051400 && valid) {
      frame.data[0] = 0x80;
      canopen::put(frame.data, 4, 4, kUnsupportedAccess);
    }
    return true;
  };
  robot.open();
  CHECK(robot.transport.warning().empty());
  CHECK(valid);
  CHECK(robot.wire.slaves().slave(3)->objects().value({0x1400, 5}) == 100);
  robot.run(20, drive_at(0.2, 0.2));
}

TEST_CASE("A time that a drive has stored for its commands does not end the set-up") {
  RobotOnBus robot;
  robot.wire.alter = [&](canopen::Frame& frame, candrives::Sender) {
    // node 1's first answer to reading its timer: 5 ms
    if (frame.id == 0x581 && frame.data[0] == 0x4b && canopen::get_unsigned(frame.data, 1, 3) == 0x051400 &&
        robot.wire.now() < std::chrono::seconds(1) && frame.data[4] == 0)
      frame.data[4] = 5;
    return true;
  };
  robot.open();
  const bool reset = std::ranges::any_of(robot.wire.log(), [](const candrives::LoggedFrame& one) {
    return one.frame.id == 0x601 && one.frame.data[0] == 0x2b &&
           canopen::get_unsigned(one.frame.data, 1, 3) == 0x051400 && canopen::get_unsigned(one.frame.data, 4, 2) == 0;
  });
  CHECK(reset);
}

TEST_CASE("Closing ends both watches: the drives hold their position without a master") {
  RobotOnBus robot;
  robot.open();
  robot.run(20, drive_at(0.2, 0.2));
  robot.transport.close();
  for (const canbus::DriveOnBus& drive : robot.description.drives) {
    const auto& objects = robot.wire.slaves().slave(drive.node)->objects();
    CHECK(objects.value({0x1016, 1}) == 0);
    CHECK(objects.value({0x1400, 5}) == 0);
  }
}

TEST_CASE("A drive that waits for its commands alone, and too long for the robot's stop, is refused") {
  const support::TemporaryFolder folder;
  const std::string device = (folder.path() / "slow.toml").string();
  std::ofstream(device) << "command_every = 3\ncommand_pdo = 2\n";
  const ChangedRobot slow({{"[can.track]\n", "[can.track]\ndevice = \"" + device + "\"\n"}});

  // Three commands, each third cycle of 20 ms: 0.18 s. From 0.5 m/s with the drives' lag 0.0651 s more
  // (robot_bus_test).
  RobotOnBus robot(slow.path());
  robot.config.period_s = 0.02;
  refuse(robot, 2, 0x101601, kObjectMissing);
  CHECK_THAT(refusal_of(robot), Catch::Contains("track right (node 2) watches its commands alone (0x1401:05)") &&
                                    Catch::Contains("0.18 s") && Catch::Contains("0.245 s") &&
                                    Catch::Contains("within 0.2 s (can.stop_within_s)"));
  CHECK(robot.all_are(PowerState::switch_on_disabled));

  // With the heartbeat it does not wait so long.
  RobotOnBus both(slow.path());
  both.config.period_s = 0.02;
  CHECK_NOTHROW(both.open());
}

TEST_CASE("Three commands may stay away at least") {
  canbus::RobotBus bus = canbus::load_robot_bus("kenaf");
  CHECK(longest_command_gap_s(bus, 0, 0.01) == 0.1);
  bus.master_silence_s = 0.01;
  CHECK(longest_command_gap_s(bus, 0, 0.02) == Approx(0.06));
  bus.drives[0].device.command_every = 3;
  CHECK(longest_command_gap_s(bus, 0, 0.02) == Approx(0.18));
}
