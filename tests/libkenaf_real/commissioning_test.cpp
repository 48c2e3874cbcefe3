// What is written to a drive, by hand.
#include "can/canbus/node_setup.hpp"

#include <catch2/catch.hpp>

using namespace kenaf;

TEST_CASE("The time between targets is in milliseconds where it is a whole number of them, else as fine as it fits") {
  canbus::RobotBus bus = canbus::load_robot_bus("kenaf");
  bus.drives[0].mode = canopen::DriveMode::cyclic_velocity;
  struct Case {
    double period_s;
    std::int64_t number, exponent;
  };
  // 0x60C2: number * 10^exponent s, the number of 8 bits. There are drives that take no exponent but -3.
  for (const Case& one :
       {Case{0.01, 10, -3}, Case{0.02, 20, -3}, Case{0.005, 5, -3}, Case{0.0025, 250, -5}, Case{0.0015, 150, -5}}) {
    std::optional<std::int64_t> number, exponent;
    for (const canbus::SdoStep& step : set_up_of_drive(bus, 0, one.period_s)) {
      if (step.what.object == canopen::object::interpolation_period.object) number = step.what.value;
      if (step.what.object == canopen::object::interpolation_exponent.object) exponent = step.what.value;
    }
    CAPTURE(one.period_s);
    CHECK(number == one.number);
    CHECK(exponent == one.exponent);
  }
}

TEST_CASE("A drive that gets each third command is told the time between those") {
  canbus::RobotBus bus = canbus::load_robot_bus("kenaf");
  bus.drives[2].mode = canopen::DriveMode::cyclic_position;
  bus.drives[2].device.command_every = 3;
  for (const canbus::SdoStep& step : set_up_of_drive(bus, 2, 0.01)) {
    if (step.what.object == canopen::object::interpolation_period.object) CHECK(step.what.value == 30);
    if (step.what.object == canopen::object::interpolation_exponent.object) CHECK(step.what.value == -3);
  }
}
