// Slopes of the CiA 410 sensor, whatever unit it counts in.
#include <catch2/catch.hpp>

#include "hrt/error.hpp"
#include "tests/libkenaf_real/robot_on_bus.hpp"

using namespace kenaf;
using namespace kenaf::real;

namespace {

// As its maker's tool, before the robot is opened: object 0x6000, in thousandths of a degree.
void set_resolution(RobotOnBus& robot, std::uint8_t thousandths) {
  robot.wire.run_until(std::chrono::milliseconds(10));
  robot.wire.send_as_other({.id = 0x607, .length = 8, .data = {0x2b, 0x00, 0x60, 0, thousandths}});
  robot.wire.run_until(std::chrono::milliseconds(20));
}

std::int64_t resolution(RobotOnBus& robot) {
  return robot.wire.slaves().slave(7)->objects().value({0x6000, 0});
}

}  // namespace

TEST_CASE("A slope of 40 degrees is measured by a sensor of any unit, also one too fine for 16 bits") {
  constexpr double kSlope_rad = 0.698132;  // 40 degrees: 40,000 thousandths, and 16 bits end at 32,767
  for (const auto& [set, in_force, unit_rad] :
       {std::tuple{1, 10, 1.75e-4}, {10, 10, 1.75e-4}, {100, 100, 1.75e-3}, {200, 10, 1.75e-4}}) {
    RobotOnBus robot;
    set_resolution(robot, static_cast<std::uint8_t>(set));  // 200 is none: the sensor keeps its own
    robot.open();
    CAPTURE(set);
    CHECK(resolution(robot) == in_force);
    robot.plant.pitch_rad = kSlope_rad;
    robot.plant.roll_rad = -kSlope_rad;
    const robot::State state = robot.run(3, robot::Command{});
    CHECK(state.posture_rad[0] == Approx(-kSlope_rad).margin(unit_rad));
    CHECK(state.posture_rad[1] == Approx(kSlope_rad).margin(unit_rad));
  }
}

TEST_CASE("A sensor that counts in thousandths of a degree and keeps to them is refused") {
  // the write gets lost, and the sensor says that it may not be written, or that it was
  for (const bool aborts : {true, false}) {
    RobotOnBus robot;
    set_resolution(robot, 1);
    robot.wire.alter = [&](canopen::Frame& frame, candrives::Sender sender) {
      const bool is_write = sender == candrives::Sender::master && frame.id == 0x607 && frame.data[0] == 0x2b &&
                            canopen::get_unsigned(frame.data, 1, 3) == 0x006000;
      if (!is_write) return true;
      canopen::Frame answer{.id = 0x587, .length = 8, .data = {0x60, 0x00, 0x60}};
      if (aborts) {
        answer.data[0] = 0x80;
        canopen::put(answer.data, 4, 4, 0x06010002);  // an object that is only read
      }
      robot.wire.send_as_other(answer);
      return false;
    };
    CHECK_THROWS_WITH(robot.open(),
                      Catch::StartsWith("inclinometer (node 7): its slopes are in thousandths of a degree (object "
                                        "0x6000 = 1), so that those beyond 32.767 degrees would be wrong, and it ") &&
                          Catch::Contains(aborts ? "does not take hundredths" : "keeps that") &&
                          Catch::EndsWith("; set it to 10 with its maker's tool"));
    CHECK(robot.all_are(canopen::PowerState::switch_on_disabled));
  }
}
