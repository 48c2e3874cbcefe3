// What a cycle of the bus costs, reckoned by hand.
#include <catch2/catch.hpp>
#include <set>

#include "can/canbus/bus_layout.hpp"

using namespace kenaf;

TEST_CASE("The loop at 100 Hz fills less than half of a bus of 500 kbit/s, with as many stuff bits as there can be") {
  const canbus::RobotBus bus = canbus::load_robot_bus("kenaf");
  // Bits of a frame of n bytes: 47 + 8 n + floor((33 + 8 n) / 4). 0 bytes: 55, 1: 65, 2: 75, 4: 95, 6: 115, 8: 135.
  // A cycle: SYNC 55; six states of 6 bytes, two efforts of 6, four of 2 at each fifth SYNC, a voltage of 4 at each
  // tenth, six commands of 6, slopes of 4, the gyro's 8.
  const double cycle_bits = 55 + 6 * 115 + 2 * 115 + 4 * 75 / 5.0 + 95 / 10.0 + 6 * 115 + 95 + 135;
  // Heartbeats a second: 50 of the master, 10 of each of eight nodes.
  const double bits_per_s = 100 * cycle_bits + (50 + 80) * 65;
  CHECK(canbus::worst_case_bits_per_s(bus, 0.01) == Approx(bits_per_s));
  CHECK(bits_per_s == Approx(204900));  // 41 %
  CHECK(canbus::worst_case_bits_per_s(bus, 0.01) < 0.5 * 500e3);
  CHECK(canbus::frames_per_s(bus, 0.01) == Approx(100 * (1 + 6 + 2 + 0.8 + 0.1 + 6 + 1 + 1) + 130));
}

TEST_CASE("No identifier that the master hears is asked for twice") {
  const auto ids = canbus::ids_to_hear(canbus::load_robot_bus("kenaf"));
  CHECK(std::set(ids.begin(), ids.end()).size() == ids.size());
  CHECK(ids.size() == 2 + 8 * 7);
}
