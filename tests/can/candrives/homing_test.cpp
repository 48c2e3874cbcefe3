// Homing: method 37 takes the position there is, 17 and 18 look for a limit switch. Flippers 3 (direction +1) and 4
// (-1) have encoders that begin anywhere; their joints end at -3 and +3 rad = 30000 counts, the switches close 1 mrad =
// 10 counts before.
#include <catch2/catch.hpp>

#include "tests/can/candrives/easy_robot.hpp"

using namespace kenaf;
using namespace kenaf::candrives;

namespace {

constexpr std::int64_t kReached = 1 << 10, kAttained = 1 << 12, kError = 1 << 13;

canbus::RobotBus with_homing() {
  canbus::RobotBus bus = easy_robot();
  for (canbus::DriveOnBus& drive : bus.drives) {
    if (drive.is_flipper()) drive.homing = canbus::Homing{};
  }
  return bus;
}

void begin_homing(EasyRobot& robot, canopen::NodeId node, int method, std::int64_t offset) {
  robot.write(node, 0x6098, 0, 1, method);
  robot.write(node, 0x607c, 0, 4, offset);
  robot.write(node, 0x6099, 1, 4, 5000);  // to the switch: 0.5 rad/s
  robot.write(node, 0x6099, 2, 4, 500);   // off it
  robot.write(node, 0x609a, 0, 4, 50'000);
  robot.enable(node, 6);
  robot.write(node, 0x6040, 0, 2, 0x1f);
}

}  // namespace

TEST_CASE("Homing method 37: here is home, and nothing moves", "[homing]") {
  EasyRobot robot(IdealPlant({1.0, 1.0, 1.0, 1.0}), with_homing());
  CHECK(robot.value(3, 0x6064) == 0);  // not known before
  begin_homing(robot, 3, 37, 12'345);
  robot.wait(1);
  CHECK(robot.value(3, 0x6064) == 12'345);
  CHECK((robot.value(3, 0x6041) & (kReached | kAttained | kError)) == (kReached | kAttained));
  CHECK(robot.plant.state().flipper_rad[0] == 1.0);
  // and then it goes where the position says: 1000 counts further are 0.1 rad
  robot.write(3, 0x6040, 0, 2, 0x0f);
  robot.write(3, 0x6060, 0, 1, 1);
  robot.wait(1);
  robot.write(3, 0x607a, 0, 4, 13'345);
  robot.write(3, 0x6040, 0, 2, 0x1f);
  robot.wait(2000);
  CHECK(robot.plant.state().flipper_rad[0] == Approx(1.1));
}

TEST_CASE("Homing methods 17 and 18: onto the switch, slowly back, home where it lets go", "[homing]") {
  // 17: the negative end of node 3 is -3 rad, of node 4, which turns the other way, +3 rad. 18: the other ends.
  const auto [node, method, end_rad] =
      GENERATE(table<int, int, double>({{3, 17, -3.0}, {4, 17, 3.0}, {3, 18, 3.0}, {4, 18, -3.0}}));
  const double start_rad = end_rad > 0 ? 2.0 : -2.0;
  EasyRobot robot(IdealPlant({start_rad, start_rad, start_rad, start_rad}), with_homing());
  const auto id = static_cast<canopen::NodeId>(node);
  const auto angle = [&, flipper = static_cast<std::size_t>(node - 3)] {
    return robot.plant.state().flipper_rad[flipper];
  };
  begin_homing(robot, id, method, 30'000);
  robot.wait(1000);                                                     // 0.5 rad/s
  CHECK(std::abs(angle() - start_rad) == Approx(0.475).margin(0.001));  // less v^2/2a = 0.025 rad
  CHECK((robot.value(id, 0x6041) & (kReached | kAttained)) == 0);
  robot.wait(3000);
  CHECK((robot.value(id, 0x6041) & (kReached | kAttained | kError)) == (kReached | kAttained));
  // Home, where the position is 30000, is 10 counts before the end, found within a step of 0.5 counts. The motor stands
  // off it by that step and the way to stop from 500 counts/s: 2.5 counts.
  const double home_rad = end_rad > 0 ? end_rad - 0.001 : end_rad + 0.001;
  const double counts_per_rad = node == 3 ? 10'000 : -10'000;
  const double from_home = (angle() - home_rad) * counts_per_rad;
  CHECK(static_cast<double>(robot.value(id, 0x6064)) - 30'000 == Approx(from_home).margin(1.5));
  CHECK(std::abs(from_home) < 4);
}

TEST_CASE("Homing ends with an error where the motor is held up, and stops where it is told to", "[homing]") {
  SECTION("on command: bit 4 goes") {
    EasyRobot robot(IdealPlant(), with_homing());
    begin_homing(robot, 3, 17, 0);
    robot.wait(200);
    robot.write(3, 0x6040, 0, 2, 0x0f);
    robot.wait(200);
    CHECK(robot.plant.state().flipper_radps[0] == 0);
    CHECK((robot.value(3, 0x6041) & (kReached | kAttained | kError)) == kReached);
  }
  SECTION("held up: 0.1 rad behind its demand") {
    Homing homing;
    Demand demand;
    homing.start({17, 5000, 500, 50'000, 1000}, 0);
    int steps = 0;
    while (homing.is_moving() && steps < 1000) {
      homing.step(demand, 0, false, false, 0.001);
      ++steps;
    }
    CHECK(homing.phase() == Homing::Phase::failed);
    CHECK(steps == Approx(250).margin(3));  // 5000 counts/s after 0.1 s and 250 counts; 750 counts more take 0.15 s
    for (int i = 0; i < 200; ++i) homing.step(demand, 0, false, false, 0.001);
    CHECK(demand.velocity == 0);
  }
}
