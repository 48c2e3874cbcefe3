// What is written to a drive, by hand.
#include "libkenaf_real/commissioning.hpp"

#include <catch2/catch.hpp>

using namespace kenaf;
using namespace kenaf::real;

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
    for (const canopen::SdoWrite& write : parameters_of(bus, 0, one.period_s)) {
      if (write.object == canopen::object::interpolation_period.object) number = write.value;
      if (write.object == canopen::object::interpolation_exponent.object) exponent = write.value;
    }
    CAPTURE(one.period_s);
    CHECK(number == one.number);
    CHECK(exponent == one.exponent);
  }
}
