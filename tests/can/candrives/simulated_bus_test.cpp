#include "tests/support/simulated_bus.hpp"

#include <catch2/catch.hpp>

#include "tests/can/candrives/easy_robot.hpp"

using namespace kenaf;
using namespace kenaf::candrives;
using namespace std::chrono_literals;

namespace {

Lines receive_all(SimulatedBus& bus, canopen::Time until) {
  Lines lines;
  while (const auto received = bus.receive(until)) lines.push_back(text(received->frame));
  return lines;
}

}  // namespace

TEST_CASE("Frames take their time, one after another, the lowest identifier first", "[bus]") {
  IdealPlant plant;
  SimulatedBus bus(easy_robot(), plant);
  // A frame of one byte has at most 47 + 8 + floor(41 / 4) = 65 bits: 130 us. Eight boot-up messages wait at time 0.
  for (int node = 1; node <= 8; ++node) {
    const auto received = bus.receive(1s);
    REQUIRE(received);
    CHECK(received->frame.id == 0x700 + node);
    CHECK(received->at == node * 130us);
    CHECK(bus.now() == received->at);
  }
  CHECK_FALSE(bus.receive(1s));
  CHECK(bus.now() == 1s);
  CHECK(bus.load() == Approx(8 * 130e-6).epsilon(1e-9));
  // An SDO frame has at most 47 + 64 + floor(97 / 4) = 135 bits: 270 us there, 270 us back.
  bus.send(frame("602#4000100000000000"));
  bus.send(frame("601#4000100000000000"));
  CHECK(bus.receive(2s)->at == 1s + 540us);  // 0x581 goes before 0x602, which has waited longer
  CHECK(bus.receive(2s)->at == 1s + 1080us);
  CHECK(text(bus.log()[8].frame) == "601#4000100000000000");
  CHECK(bus.log()[8].sender == Sender::master);
}

TEST_CASE("SYNC comes at once and then each period, to the master too", "[bus]") {
  IdealPlant plant;
  SimulatedBus bus(easy_robot(), plant);
  receive_all(bus, 100ms);
  bus.send(frame("000#0108"));  // the gyro sends at each SYNC
  bus.start_sync(10ms);
  CHECK(receive_all(bus, 121ms) == Lines{"080#", "188#00000000", "080#", "188#00000000", "080#", "188#00000000"});
  // a frame without data has 47 + floor(33 / 4) = 55 bits
  CHECK(bus.log().end()[-2].at == 120ms + 110us);
  bus.stop_sync();
  CHECK(receive_all(bus, 200ms).empty());
}

TEST_CASE("A bus that is down throws, a dead master is not heard, frames can be altered and dropped", "[bus]") {
  IdealPlant plant;
  SimulatedBus bus(easy_robot(), plant);
  receive_all(bus, 100ms);
  const auto request = frame("601#4000100000000000");
  SECTION("down and up") {
    bus.go_down("vcan0 is down");
    CHECK_THROWS_AS(bus.send(request), canopen::BusError);
    CHECK_THROWS_AS(bus.receive(1s), canopen::BusError);
    bus.run_until(200ms);
    bus.come_up();
    bus.send(request);
    CHECK(receive_all(bus, 300ms).size() == 1);
  }
  SECTION("dead master") {
    bus.start_sync(10ms);
    bus.stop_master();
    bus.send(request);
    CHECK(receive_all(bus, 300ms).empty());
    CHECK(bus.now() == 300ms);
  }
  SECTION("altered and dropped") {
    bus.alter = [](canopen::Frame& one, Sender sender) {
      if (sender == Sender::slaves) one.length = 7;
      return one.id != 0x602;
    };
    bus.send(request);
    bus.send(frame("602#4000100000000000"));
    CHECK(receive_all(bus, 300ms) == Lines{"581#43001000920102"});
  }
  SECTION("interrupted: once") {
    bus.interrupt();
    CHECK_FALSE(bus.receive(300ms));
    CHECK(bus.now() == 100ms);
    CHECK_FALSE(bus.receive(300ms));
    CHECK(bus.now() == 300ms);
  }
}
