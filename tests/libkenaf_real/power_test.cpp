// From drives that hold to drives that obey, and back: no drive is let go of while it does not show that it stands, and
// none that holds the robot is without torque while another program takes over.
#include <catch2/catch.hpp>
#include <set>

#include "hrt/error.hpp"
#include "tests/libkenaf_real/changed_robot.hpp"
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

namespace {

// Answers to SDO requests come 9 ms after them at the earliest, with the next frame that anybody sends.
void delay_answers(RobotOnBus& robot) {
  struct Late {
    canopen::Frame frame;
    canopen::Time due;
  };
  robot.wire.alter = [&robot, late = std::vector<Late>()](canopen::Frame& frame, Sender sender) mutable {
    if (sender == Sender::other) return true;
    const canopen::Time now = robot.wire.now();
    const std::vector<Late> waiting = std::exchange(late, {});
    for (const Late& one : waiting) now >= one.due ? robot.wire.send_as_other(one.frame) : late.push_back(one);
    if (frame.id < 0x581 || frame.id > 0x5ff) return true;
    late.push_back({frame, now + std::chrono::milliseconds(9)});
    return false;
  };
}

bool ends_event_timer(const candrives::LoggedFrame& one, canopen::NodeId node) {
  return one.sender == Sender::master && one.frame.id == 0x600 + node &&
         canopen::get_unsigned(one.frame.data, 1, 3) == 0x051400 && canopen::get_unsigned(one.frame.data, 4, 2) == 0;
}

}  // namespace

TEST_CASE("Closing leaves no drive without commands until its event timer has ended, flippers' first") {
  RobotOnBus robot;
  robot.open();
  robot.run(20, robot::Command{});
  robot.wire.inject({candrives::FaultKind::missing_commands_fault, 0});
  delay_answers(robot);
  const canopen::Time begin = robot.wire.now();
  CHECK(error_of_closing(robot).code() == HRT_OK);

  // Six timers, then six watches of the heartbeat: were they ended in one go, with 10 ms for each of twelve answers,
  // the last drive would wait for more than its timer's 0.1 s. A cycle has 10 ms, and an answer may take one.
  std::vector<canopen::NodeId> order;
  for (canopen::NodeId node = 1; node <= 6; ++node) {
    canopen::Time last = begin, longest_gap{};
    bool has_ended = false;
    for (const candrives::LoggedFrame& one : robot.wire.log()) {
      if (one.at < begin || has_ended) continue;
      has_ended = ends_event_timer(one, node);
      if (!has_ended && (one.sender != Sender::master || one.frame.id != 0x200 + node)) continue;
      longest_gap = std::max(longest_gap, one.at - last);
      last = one.at;
    }
    CAPTURE(static_cast<int>(node));
    CHECK(has_ended);
    CHECK(longest_gap <= std::chrono::milliseconds(35));
  }
  for (const candrives::LoggedFrame& one : robot.wire.log()) {
    for (canopen::NodeId node = 1; node <= 6; ++node) {
      if (one.at >= begin && ends_event_timer(one, node)) order.push_back(node);
    }
  }
  CHECK(order == std::vector<canopen::NodeId>{3, 4, 5, 6, 1, 2});
  CHECK(robot.all_are(PowerState::quick_stop_active));
}

TEST_CASE("Closing says which drive no longer holds its position when it has stopped") {
  RobotOnBus robot;
  robot.open();
  robot.run(20, robot::Command{});
  // as a drive whose maker answers missing commands by a fault: it fails while the watches are ended
  bool has_failed = false;
  robot.wire.alter = [&](canopen::Frame& frame, Sender sender) {
    if (sender == Sender::master && frame.id == 0x606 && !std::exchange(has_failed, true))
      robot.wire.inject({candrives::FaultKind::error, 6, canopen::kErrorPdoTimeOut});
    return true;
  };
  const hrt::Error error = error_of_closing(robot);
  CHECK(has_failed);
  CHECK(error.code() == HRT_E_DEVICE);
  CHECK_THAT(error.what(), Catch::StartsWith("closed, and at rest, but not held with torque: flipper rear right (node "
                                             "6) is in the state \"fault\"") &&
                               Catch::Contains("support the robot"));
}

TEST_CASE("Closing waits for a robot that takes longer to stop than others") {
  // Husky from 1.2 m/s: 0.16 s of ramp at 7.5 m/s^2 and 0.36 s of its drives' lag (can-robot.md), more than 0.3 s.
  RobotOnBus robot("husky");
  robot.plant.speed_loop_s = robot.description.speed_loop_s;
  robot.open();
  const double full_mps = robot.description.drives.front().max_speed;
  robot.run(300, drive_at(full_mps, full_mps));
  const double begin_s = robot.seconds();
  CHECK(error_of_closing(robot).code() == HRT_OK);
  CHECK(robot.seconds() - begin_s >= 0.3);
  CHECK(std::abs(robot.plant.state().track_mps[0]) <= canbus::kAtRest_mps);
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

TEST_CASE("A flipper under load stays where it was enabled while others are not yet") {
  constexpr double kSag_rad = 0.004;
  for (const std::string mode : {"cyclic position", "profile position"}) {
    const ChangedRobot changed({{"mode = \"profile position\"", "mode = \"" + mode + "\""}});
    RobotOnBus robot(changed.path());
    robot.plant.flipper_sag_rad = kSag_rad;
    // node 6 gets to be enabled half a second after the others
    int lost = 0;
    robot.wire.alter = [&](canopen::Frame& frame, Sender sender) {
      return sender != Sender::master || frame.id != 0x206 || word_of(frame) != canopen::kControlEnable || ++lost > 50;
    };
    robot.open();
    const robot::State opened = robot.run(1, robot::Command{});
    const robot::State later = robot.run(200, robot::Command{});
    CAPTURE(mode, lost);
    CHECK(lost > 50);
    // It lies below its demand by the sag, and by as much again each time that its drive demands what is measured: as
    // it is enabled, and with its first target in cyclic mode. Targets that went on following would let it down by
    // 0.1 rad meanwhile, a sag each second cycle.
    CHECK(opened.flipper_rad[robot::kFrontLeft] == Approx(0).margin(3 * kSag_rad + 1e-4));
    CHECK(later.flipper_rad[robot::kFrontLeft] == Approx(opened.flipper_rad[robot::kFrontLeft]).margin(1e-4));
  }
}

TEST_CASE("A flipper under load that is homed stays at home when its mode is its own again") {
  constexpr double kSag_rad = 0.004;
  const ChangedRobot changed({{"mode = \"profile position\"", "mode = \"cyclic position\""},
                              {"\n[can.inclinometer]", std::string(kHomeHere) + "\n[can.inclinometer]"}});
  RobotOnBus robot(changed.path());
  robot.plant.flipper_sag_rad = kSag_rad;
  robot.open();
  CHECK(robot.run(200, robot::Command{}).flipper_rad[robot::kFrontLeft] == Approx(0.7).margin(3 * kSag_rad));
}
