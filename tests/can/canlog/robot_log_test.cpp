// A whole run of the real library on the simulated drives, as a log: it keeps every rule, and its figures are the
// bus's.
#include <catch2/catch.hpp>
#include <set>
#include <string>

#include "can/canlog/figures.hpp"
#include "can/canlog/rules.hpp"
#include "hrt/error.hpp"
#include "tests/libkenaf_real/changed_robot.hpp"
#include "tests/libkenaf_real/robot_on_bus.hpp"

using namespace kenaf;
using namespace kenaf::canlog;
using candrives::FaultKind;

namespace {

Log log_of(const candrives::SimulatedBus& wire) {
  Log log{.interface = "vcan0"};
  for (const candrives::LoggedFrame& one : wire.log())
    log.frames.push_back({log.frames.size() + 1, one.at, canopen::FrameKind::data, one.frame});
  return log;
}

// The names of the rules that the robot's log breaks; what broke them is reported.
std::set<std::string> broken_rules(const real::RobotOnBus& robot) {
  // the master waits for answers for 0.6 of its period
  CheckOptions options;
  options.sync_window = std::chrono::milliseconds(6);
  std::set<std::string> names;
  for (const Violation& one : check_rules(log_of(robot.wire), Network(robot.description), options)) {
    if (names.emplace(one.rule.name).second)
      UNSCOPED_INFO("line " << one.line << ": " << one.rule.name << ": " << one.words);
  }
  return names;
}

// Forward, a turn, a flipper there and back, and the end.
void drive(real::RobotOnBus& robot) {
  robot.open();
  robot.run(50, real::drive_at(0.3, 0.3));
  robot::Command command = real::drive_at(-0.2, 0.2);
  command.flipper[robot::kFrontLeft] = {robot::JointMode::angle, 0.4};
  robot.run(60, command);
  command.flipper[robot::kFrontLeft].value = 0;
  robot.run(60, command);
  robot.run(10, {});
  robot.transport.close();
}

const std::set<std::string> kNone;

}  // namespace

TEST_CASE("The real library and the simulated drives break no rule, from boot to stop, twice") {
  const real::ChangedRobot cyclic({{"profile velocity", "cyclic velocity"}, {"profile position", "cyclic position"}});
  for (const std::string& description : {std::string("kenaf"), cyclic.path()}) {
    INFO(description);
    real::RobotOnBus robot(description);
    drive(robot);
    robot.wire.run_until(robot.wire.now() + std::chrono::seconds(1));
    drive(robot);
    CHECK(broken_rules(robot) == kNone);
  }
}

TEST_CASE("Homing: the bit that starts it is down before the mode changes") {
  // bit 4 of the controlword starts the homing, and is a new set-point in profile position mode
  const real::ChangedRobot homed({{"\n[can.inclinometer]", std::string(real::kHomeHere) + "\n[can.inclinometer]"}});
  real::RobotOnBus robot(homed.path());
  drive(robot);
  CHECK(broken_rules(robot) == kNone);
}

TEST_CASE("A robot that loses a node: what the loss itself breaks is found, and nothing else") {
  // The heartbeat of a lost robot ends on purpose, so that its drives stop by themselves. The robot goes on without its
  // inclinometer.
  struct {
    candrives::Fault fault;
    std::set<std::string> rules;
  } const cases[] = {
      {{FaultKind::error, 5, 0x2310}, {"master-heartbeat"}},
      {{FaultKind::silent, 3}, {"master-heartbeat", "sync-pdo"}},
      {{FaultKind::power_loss, 2}, {"master-heartbeat", "sync-pdo"}},
      {{FaultKind::short_pdos, 1}, {"master-heartbeat", "sync-pdo", "length"}},
      {{FaultKind::silent, 7}, {"sync-pdo"}},
  };
  for (const auto& one : cases) {
    INFO("fault " << static_cast<int>(one.fault.kind) << " of node " << int{one.fault.node});
    real::RobotOnBus robot;
    robot.open();
    robot.run(30, real::drive_at(0.2, 0.2));
    robot.wire.inject(one.fault);
    try {
      robot.run(20, real::drive_at(0.2, 0.2));
    } catch (const hrt::Error&) {
    }
    robot.transport.close();
    robot.wire.run_until(robot.wire.now() + std::chrono::milliseconds(700));
    robot.wire.inject({FaultKind::healed, 0});
    drive(robot);
    CHECK(broken_rules(robot) == one.rules);
  }
}

TEST_CASE("The figures of a driven robot: less than half of the bus, no command late") {
  real::RobotOnBus robot;
  drive(robot);
  const Figures figures = figures_of(log_of(robot.wire), Network(robot.description));
  CHECK(*figures.period_s == Approx(0.01));
  CHECK(figures.gaps == 0);
  // In the loop as worked out in tests/can/canbus/bus_layout_test.cpp: 41 % with as many stuff bits as there can be.
  // Power-up has some cycles of SDO instead of commands.
  CHECK(figures.with_sync->worst_case_bits_per_s < 204'900);
  CHECK(figures.with_sync->bits_per_s > 0.7 * figures.with_sync->worst_case_bits_per_s);
  CHECK(figures.with_sync->bits_per_s < figures.with_sync->worst_case_bits_per_s);
  CHECK(figures.driven_cycles > 150);
  CHECK(figures.late_commands == 0);
  // the six states and two efforts of 115 bits, slopes and gyro cannot be through in less than 8 * 93 bits' time
  CHECK(figures.answer_time->median_s > 8 * 93 / 500e3);
  CHECK(figures.answer_time->max_s < 0.006);
  CHECK(figures.command_time->max_s < 0.01);
}
