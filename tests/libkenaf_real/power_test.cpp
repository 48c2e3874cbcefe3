// From drives that hold to drives that obey, and back: no drive is let go of while it does not show that it stands, and
// none that holds the robot is without torque while another program takes over.
#include <catch2/catch.hpp>
#include <set>

#include "hrt/error.hpp"
#include "tests/libkenaf_real/robot_on_bus.hpp"

using namespace kenaf;
using namespace kenaf::real;
using candrives::Sender;
using canopen::PowerState;

namespace {

// The controlword or statusword of a frame that carries one: the first two bytes of an RPDO1 or a TPDO1.
std::uint32_t word_of(const canopen::Frame& frame) {
  return canopen::get_unsigned(frame.data, 0, 2);
}

hrt::Error error_of_closing(RobotOnBus& robot) {
  try {
    robot.transport.close();
  } catch (const hrt::Error& error) {
    return error;
  }
  return {HRT_OK, ""};
}

void lose_quick_stops_of_node_2(RobotOnBus& robot) {
  robot.wire.alter = [](canopen::Frame& frame, Sender sender) {
    return sender != Sender::master || frame.id != 0x202 || word_of(frame) != canopen::kControlQuickStop;
  };
}

}  // namespace

TEST_CASE("Closing stops a track also where its first order to stop is lost") {
  RobotOnBus robot;
  robot.open();
  robot.run(50, drive_at(0.2, 0.2));
  bool was_lost = false;
  robot.wire.alter = [&](canopen::Frame& frame, Sender sender) {
    const bool first = sender == Sender::master && frame.id == 0x202 && word_of(frame) == canopen::kControlQuickStop &&
                       !std::exchange(was_lost, true);
    return !first;
  };
  CHECK(error_of_closing(robot).code() == HRT_OK);
  CHECK(was_lost);
  CHECK(robot.stands());
  CHECK(robot.all_are(PowerState::quick_stop_active));
}

TEST_CASE("A drive that does not get its quick stop misses its commands, and closing sees it stop by that") {
  RobotOnBus robot;
  robot.open();
  robot.run(50, drive_at(0.2, 0.2));
  lose_quick_stops_of_node_2(robot);
  CHECK(error_of_closing(robot).code() == HRT_OK);
  CHECK(robot.stands());
  CHECK(robot.all_are(PowerState::quick_stop_active));
}

TEST_CASE("Closing leaves a drive that does not stop to its watch of the heartbeat, and names it") {
  RobotOnBus robot;
  robot.open();
  robot.run(50, drive_at(0.2, 0.2));
  robot.wire.inject({candrives::FaultKind::no_event_timer, 2});
  lose_quick_stops_of_node_2(robot);
  const hrt::Error error = error_of_closing(robot);
  CHECK(error.code() == HRT_E_DEVICE);
  CHECK_THAT(error.what(), Catch::Contains("track right (node 2)") && Catch::Contains("operation enabled"));
  CHECK_FALSE(Catch::Contains("track left").match(error.what()));
  // it misses the heartbeat 0.1 s after the last one, and needs 0.2 m/s / 12.5 m/s^2 = 16 ms then
  CHECK(robot.seconds_to_rest() <= 0.1 + 0.016 + 0.002);
  CHECK(robot.all_are(PowerState::quick_stop_active));
}

TEST_CASE("Drives that hold the robot keep their torque while the next program takes them over") {
  enum class End { closed, killed, interface_down };
  for (const End end : {End::closed, End::killed, End::interface_down}) {
    RobotOnBus robot;
    robot.open();
    robot.run(50, drive_at(0.2, 0.2));
    switch (end) {
      case End::closed:
        robot.transport.close();
        break;
      case End::killed:
        // nothing more is said to the drives: their last controlword is "enable", and they stop by themselves
        robot.wire.alter = [](canopen::Frame&, Sender sender) { return sender != Sender::master; };
        robot.wire.stop_sync();
        robot.wire.run_until(robot.wire.now() + std::chrono::milliseconds(300));
        break;
      case End::interface_down:
        robot.wire.go_down("CAN interface 'can0' went down");
        robot.wire.run_until(robot.wire.now() + std::chrono::milliseconds(300));
        CHECK_THROWS_AS(robot.run(1, robot::Command{}), hrt::Error);
        robot.transport.close();
        robot.wire.come_up();
        break;
    }
    REQUIRE(robot.all_are(PowerState::quick_stop_active));
    CanTransport next([&](const std::string&, auto) { return std::make_unique<BorrowedBus>(robot.wire); });
    std::set<PowerState> seen;
    robot.wire.alter = [&](canopen::Frame& frame, Sender sender) {
      if (sender == Sender::slaves && frame.id >= 0x181 && frame.id <= 0x186)  // TPDO1 of the drives
        seen.insert(canopen::power_state_of(static_cast<std::uint16_t>(word_of(frame))));
      return true;
    };
    next.open(robot.config);
    CAPTURE(static_cast<int>(end));
    CHECK(seen == std::set{PowerState::operation_enabled, PowerState::quick_stop_active});
    CHECK(robot.all_are(PowerState::operation_enabled));
    next.close();
  }
}

TEST_CASE("A drive that has not been heard yet is not told anything") {
  RobotOnBus robot;
  robot.open();
  robot.transport.close();
  REQUIRE(robot.all_are(PowerState::quick_stop_active));
  bool was_missed = false;
  std::set<PowerState> states;
  robot.wire.alter = [&](canopen::Frame& frame, Sender sender) {
    states.insert(robot.power(2));
    return sender != Sender::slaves || frame.id != 0x183 || std::exchange(was_missed, true);
  };
  robot.open();
  CHECK(was_missed);
  CHECK(states == std::set{PowerState::operation_enabled, PowerState::quick_stop_active});
}
