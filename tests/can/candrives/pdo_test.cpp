// Process data: which records a master may write in which order, and what is taken and sent when.
#include <catch2/catch.hpp>

#include "tests/can/candrives/easy_robot.hpp"

using namespace kenaf;
using namespace kenaf::candrives;
using canopen::PowerState;

namespace {

constexpr std::uint16_t kRpdo1 = 0x1400, kRpdo1Mapping = 0x1600, kTpdo1 = 0x1800;

std::string done(std::uint16_t index, std::uint8_t sub) {
  canopen::Frame answer{.id = 0x581, .length = 8};
  answer.data[0] = 0x60;
  canopen::put(answer.data, 1, 2, index);
  answer.data[3] = sub;
  return text(answer);
}

std::string refused(std::uint16_t index, std::uint8_t sub, std::uint32_t code) {
  canopen::Frame answer = frame(done(index, sub));
  answer.data[0] = 0x80;
  canopen::put(answer.data, 4, 4, code);
  return text(answer);
}

// RPDO1 of node 1 takes controlword and target velocity at each SYNC.
void map_velocity(EasyRobot& robot) {
  CHECK(robot.write(1, kRpdo1, 1, 4, 0x80000201) == done(kRpdo1, 1));
  CHECK(robot.write(1, kRpdo1, 2, 1, 1) == done(kRpdo1, 2));
  CHECK(robot.write(1, kRpdo1Mapping, 0, 1, 0) == done(kRpdo1Mapping, 0));
  CHECK(robot.write(1, kRpdo1Mapping, 1, 4, 0x60400010) == done(kRpdo1Mapping, 1));
  CHECK(robot.write(1, kRpdo1Mapping, 2, 4, 0x60ff0020) == done(kRpdo1Mapping, 2));
  CHECK(robot.write(1, kRpdo1Mapping, 0, 1, 2) == done(kRpdo1Mapping, 0));
  CHECK(robot.write(1, kRpdo1, 1, 4, 0x201) == done(kRpdo1, 1));
}

}  // namespace

TEST_CASE("A mapping is changed only while its PDO is invalid and its count is 0", "[pdo]") {
  EasyRobot robot;
  constexpr std::uint32_t kUnsupportedAccess = 0x06010000;
  CHECK(robot.write(1, kRpdo1Mapping, 0, 1, 0) == refused(kRpdo1Mapping, 0, kUnsupportedAccess));
  robot.write(1, kRpdo1, 1, 4, 0x80000201);
  CHECK(robot.write(1, kRpdo1Mapping, 1, 4, 0x60400010) == refused(kRpdo1Mapping, 1, kUnsupportedAccess));
  robot.write(1, kRpdo1, 1, 4, 0x201);
  map_velocity(robot);
}

TEST_CASE("What is mapped must exist, be mappable in that direction, have that size, and fit into eight bytes",
          "[pdo]") {
  EasyRobot robot;
  constexpr std::uint32_t kNoObject = 0x06020000, kCannotBeMapped = 0x06040041, kTooLong = 0x06040042;
  robot.write(1, kRpdo1, 1, 4, 0x80000201);
  robot.write(1, kRpdo1Mapping, 0, 1, 0);
  const auto map = [&](std::uint32_t entry) { return robot.write(1, kRpdo1Mapping, 1, 4, entry); };
  CHECK(map(0x55550010) == refused(kRpdo1Mapping, 1, kNoObject));
  CHECK(map(0x10170010) == refused(kRpdo1Mapping, 1, kCannotBeMapped));
  CHECK(map(0x60410010) == refused(kRpdo1Mapping, 1, kCannotBeMapped));  // the statusword can only be transmitted
  CHECK(map(0x60400020) == refused(kRpdo1Mapping, 1, kCannotBeMapped));  // it has 16 bits
  for (std::uint8_t sub = 1; sub <= 3; ++sub) robot.write(1, kRpdo1Mapping, sub, 4, 0x607a0020);
  CHECK(robot.write(1, kRpdo1Mapping, 0, 1, 3) == refused(kRpdo1Mapping, 0, kTooLong));  // 96 bits
  CHECK(robot.write(1, kRpdo1Mapping, 0, 1, 2) == done(kRpdo1Mapping, 0));
}

TEST_CASE("Identifiers and transmission types are held against CiA 301", "[pdo]") {
  EasyRobot robot;
  constexpr std::uint32_t kInvalidValue = 0x06090030;
  CHECK(robot.write(1, kRpdo1, 1, 4, 0x301) == refused(kRpdo1, 1, kInvalidValue));  // while it is valid
  robot.write(1, kRpdo1, 1, 4, 0x80000201);
  CHECK(robot.write(1, kRpdo1, 1, 4, 0x80000601) == refused(kRpdo1, 1, kInvalidValue));  // an SDO's
  CHECK(robot.write(1, kRpdo1, 1, 4, 0xa0000201) == refused(kRpdo1, 1, kInvalidValue));  // 29 bits
  CHECK(robot.write(1, kRpdo1, 1, 4, 0x80000321) == done(kRpdo1, 1));
  for (const int type : {241, 253}) CHECK(robot.write(1, kRpdo1, 2, 1, type) == refused(kRpdo1, 2, kInvalidValue));
  for (const int type : {0, 1, 240, 254, 255}) CHECK(robot.write(1, kRpdo1, 2, 1, type) == done(kRpdo1, 2));
}

TEST_CASE("An event-driven PDO acts at once, and what follows from it is sent at once", "[pdo]") {
  EasyRobot robot;
  CHECK(robot.send("201#0600").empty());  // pre-operational: no PDO
  CHECK(robot.send("000#0101") == Lines{"181#5002"});
  CHECK(robot.send("201#0600") == Lines{"181#3102"});  // ready to switch on
  CHECK(robot.send("201#0600").empty());
  CHECK(robot.send("202#0600").empty());  // another node's
}

TEST_CASE("A synchronous PDO is taken at the next SYNC, and the answer of that SYNC tells of it", "[pdo]") {
  EasyRobot robot;
  map_velocity(robot);
  robot.write(1, kTpdo1, 2, 1, 1);  // the statusword at each SYNC
  robot.send("000#0101");
  CHECK(robot.send("201#060000000000").empty());
  CHECK(robot.wait(5).empty());
  CHECK(robot.drive(0).power_state() == PowerState::switch_on_disabled);
  CHECK(robot.send("080#") == Lines{"181#3102"});
  CHECK(robot.drive(0).power_state() == PowerState::ready_to_switch_on);
  // of two that come between SYNCs the later counts: 7 after 15 is "switch on", not "enable"
  robot.send("201#0F0000000000");
  robot.send("201#070000000000");
  robot.send("080#");
  CHECK(robot.drive(0).power_state() == PowerState::switched_on);
  // nothing came: nothing is taken a second time
  robot.write(1, 0x60ff, 0, 4, 123);
  robot.send("080#");
  CHECK(robot.value(1, 0x60ff) == 123);
}

TEST_CASE("A PDO of transmission type 3 is sent at each third SYNC", "[pdo]") {
  EasyRobot robot;
  robot.write(1, kTpdo1, 2, 1, 3);
  robot.send("000#0101");
  std::string sent;
  for (int i = 0; i < 7; ++i) sent += robot.send("080#").empty() ? '.' : 'x';
  CHECK(sent == "..x..x.");
  CHECK(robot.send("080#00").empty());  // SYNC with counter: the eighth
  CHECK(robot.send("080#01").size() == 1);
}

TEST_CASE("A PDO that is too short is an error, one that is too long is taken with its first bytes", "[pdo]") {
  EasyRobot robot;
  robot.send("000#0101");
  CHECK(robot.send("201#06") == Lines{"081#1082110000000000"});  // 0x8210, generic and communication
  CHECK(robot.send("201#").empty());                             // the error is there already
  CHECK(robot.drive(0).power_state() == PowerState::switch_on_disabled);
  CHECK(robot.send("201#060099") == Lines{"081#0000000000000000", "181#3102"});
  CHECK(robot.drive(0).power_state() == PowerState::ready_to_switch_on);
}

TEST_CASE("The event timer and the inhibit time bound when a PDO is sent", "[pdo]") {
  EasyRobot robot;
  SECTION("event timer of 20 ms: without a change too") {
    robot.write(1, kTpdo1, 5, 2, 20);
    robot.send("000#0101");
    CHECK(robot.wait(19).empty());
    CHECK(robot.wait(1) == Lines{"181#5002"});
    CHECK(robot.wait(60).size() == 3);
  }
  SECTION("inhibit time of 10 ms: a change waits; the time itself is changed only while the PDO is invalid") {
    CHECK(robot.write(1, kTpdo1, 3, 2, 100) == refused(kTpdo1, 3, 0x06010000));
    robot.write(1, kTpdo1, 1, 4, 0xc0000181);
    robot.write(1, kTpdo1, 3, 2, 100);
    robot.write(1, kTpdo1, 1, 4, 0x40000181);
    CHECK(robot.send("000#0101").size() == 1);
    CHECK(robot.send("201#0600").empty());
    CHECK(robot.wait(9).empty());
    CHECK(robot.wait(1) == Lines{"181#3102"});
  }
}

TEST_CASE("A PDO's values are in place before its controlword acts", "[pdo]") {
  EasyRobot robot;
  robot.enable(3, 1);
  robot.write(3, 0x6081, 0, 4, 5000);
  robot.send("000#0103");
  // RPDO3, controlword and target position, is there by default, but not valid
  robot.write(3, 0x1402, 1, 4, 0x403);
  robot.send("403#1F0064000000");  // new set-point, 100 counts
  robot.wait(500);
  CHECK(robot.value(3, 0x6064) == 100);
}

TEST_CASE("Commands that stay away for longer than the event timer stop the drive, from the first one after it was set",
          "[pdo]") {
  EasyRobot robot;
  map_velocity(robot);
  robot.write(1, kTpdo1, 1, 4, 0xc0000181);  // off: it would tell each new statusword
  robot.write(1, 0x6007, 0, 2, 3);           // quick stop where the master is lost
  robot.write(1, 0x605a, 0, 2, 6);
  robot.write(1, 0x6085, 0, 4, 50'000);
  robot.send("000#0101");
  robot.enable(1, 3);
  CHECK(robot.write(1, kRpdo1, 5, 2, 50) == done(kRpdo1, 5));
  CHECK(robot.wait(1000).empty());  // none has come since
  const auto command = [&] {
    robot.send("201#0F0088130000");  // enable, 5000 counts/s
    robot.send("080#");
  };
  command();
  robot.wait(49);
  command();
  robot.send("201#0F0088");  // too short: no command
  robot.wait(1);
  CHECK(robot.wait(48).empty());
  CHECK(robot.drive(0).power_state() == PowerState::operation_enabled);
  SECTION("quick stop, and an emergency message, 0x8250, generic and communication") {
    CHECK(robot.wait(1) == Lines{"081#5082110000000000"});
    CHECK(robot.drive(0).power_state() == PowerState::quick_stop_active);
    CHECK(robot.slaves.slave(1)->state() == canopen::NmtState::operational);
    CHECK(robot.wait(1000).empty());
    // a command of full length ends both errors
    CHECK(robot.send("201#020000000000") == Lines{"081#0000110000000000", "081#0000000000000000"});
  }
  SECTION("0 ends the watch") {
    robot.write(1, kRpdo1, 5, 2, 0);
    CHECK(robot.wait(1000).empty());
    CHECK(robot.drive(0).power_state() == PowerState::operation_enabled);
  }
  SECTION("a communication reset ends the watch and resets the timer") {
    robot.send("000#8201");
    CHECK(robot.value(1, kRpdo1, 5) == 0);
    robot.send("000#0101");
    // the reset is a loss of its own (CiA 402-2, 0x6007), and TPDO1 is as from the factory again: 0x0617, quick stop
    CHECK(robot.wait(1000) == Lines{"181#1706"});
  }
  SECTION("a drive to which missing commands are a fault has one, in a quick stop, too") {
    robot.inject({FaultKind::missing_commands_fault, 1});
    robot.send("201#020000000000");
    robot.send("080#");
    REQUIRE(robot.drive(0).power_state() == PowerState::quick_stop_active);
    robot.wait(49);
    CHECK(robot.drive(0).power_state() == PowerState::quick_stop_active);
    robot.wait(5);
    CHECK(robot.drive(0).power_state() == PowerState::fault);
  }
  SECTION("a drive with this fault goes on") {
    robot.inject({FaultKind::no_event_timer, 1});
    CHECK(robot.wait(1000).empty());
    CHECK(robot.drive(0).power_state() == PowerState::operation_enabled);
    robot.inject({FaultKind::healed, 1});
    command();
    CHECK(robot.wait(50).size() == 1);
  }
}

TEST_CASE("A drive of a robot without event timers has none in its RPDOs", "[pdo]") {
  canbus::RobotBus bus = easy_robot();
  bus.event_timer = false;
  EasyRobot robot(IdealPlant(), bus);
  CHECK(robot.value(1, kRpdo1, 0) == 2);
  CHECK(robot.write(1, kRpdo1, 5, 2, 50) == refused(kRpdo1, 5, 0x06090011));
  CHECK(robot.value(1, kTpdo1, 0) == 5);
}

TEST_CASE("A drive whose first RPDO is fixed takes its mapping in the others", "[pdo]") {
  EasyRobot robot;
  robot.inject({FaultKind::first_rpdo_fixed, 1});
  CHECK(robot.write(1, kRpdo1, 1, 4, 0x80000201) == done(kRpdo1, 1));  // switching it off is no mapping
  CHECK(robot.write(1, kRpdo1Mapping, 0, 1, 0) == refused(kRpdo1Mapping, 0, 0x06040041));
  CHECK(robot.write(1, 0x1401, 1, 4, 0x80000301) == done(0x1401, 1));
  CHECK(robot.write(1, 0x1601, 0, 1, 0) == done(0x1601, 0));
  CHECK(robot.write(1, 0x1601, 1, 4, 0x60400010) == done(0x1601, 1));
}

TEST_CASE("A drive without current or voltage can neither be asked for them nor map them", "[pdo]") {
  EasyRobot robot;
  robot.inject({FaultKind::no_current, 1});
  CHECK(robot.write(1, 0x1801, 1, 4, 0x80000281) == done(0x1801, 1));
  CHECK(robot.write(1, 0x1a01, 0, 1, 0) == done(0x1a01, 0));
  CHECK(robot.write(1, 0x1a01, 1, 4, 0x60780010) == refused(0x1a01, 1, 0x06020000));
  CHECK(robot.write(1, 0x1a01, 1, 4, 0x60790020) == done(0x1a01, 1));
  CHECK(robot.send("601#4075600000000000") == Lines{"581#8075600000000206"});

  robot.inject({FaultKind::no_voltage, 1});
  CHECK(robot.write(1, 0x1a01, 2, 4, 0x60790020) == refused(0x1a01, 2, 0x06020000));
  robot.inject({FaultKind::healed, 1});
  CHECK(robot.write(1, 0x1a01, 2, 4, 0x60780010) == done(0x1a01, 2));
}
