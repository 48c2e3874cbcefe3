// Frames into values, by hand; and what is malformed changes nothing.
#include <catch2/catch.hpp>

#include "libkenaf_real/process_image.hpp"

using namespace kenaf;
using namespace kenaf::real;
using canopen::Frame;
using canopen::Time;
using std::chrono::milliseconds;

namespace {

const canbus::RobotBus kBus = canbus::load_robot_bus("kenaf");

Frame frame(std::uint16_t id, std::initializer_list<std::uint8_t> data) {
  return canopen::make_frame(id, std::vector<std::uint8_t>(data));
}

}  // namespace

TEST_CASE("A drive's state: statusword and position, little-endian and signed") {
  ProcessImage image(kBus);
  // TPDO1 of node 2: 0x180 + 2; statusword 0x1637; position -2 = 0xfffffffe
  image.on_frame({frame(0x182, {0x37, 0x16, 0xfe, 0xff, 0xff, 0xff}), milliseconds(5)});
  CHECK(image.drive(1).statusword == 0x1637);
  CHECK(image.drive(1).position == -2);
  CHECK(image.drive(1).state_at == Time(milliseconds(5)));
  CHECK_FALSE(image.drive(0).state_at);
}

TEST_CASE("A frame of the wrong length is as if it had not come") {
  ProcessImage image(kBus);
  image.on_frame({frame(0x182, {0x37, 0x16, 1, 0, 0}), milliseconds(5)});
  image.on_frame({frame(0x182, {0x37, 0x16, 1, 0, 0, 0, 0}), milliseconds(5)});
  CHECK_FALSE(image.drive(1).state_at);
  CHECK(image.drive(1).statusword == 0);
}

TEST_CASE("Tracks send speed and current, flippers current, the left track the voltage") {
  ProcessImage image(kBus);
  image.on_frame({frame(0x281, {0x10, 0x27, 0, 0, 0x18, 0xfc}), milliseconds(1)});  // 10000; -1000 of a thousand
  CHECK(image.drive(0).velocity == 10000);
  CHECK(image.drive(0).current_permil == -1000);
  image.on_frame({frame(0x283, {0xf4, 0x01}), milliseconds(1)});
  CHECK(image.drive(2).current_permil == 500);
  image.on_frame({frame(0x381, {0x2c, 0x65, 0, 0}), milliseconds(1)});  // 25900 mV
  CHECK(image.battery_v() == Approx(25.9));
}

TEST_CASE("An emergency stays until it is cleared") {
  ProcessImage image(kBus);
  image.on_frame({frame(0x83, {0x10, 0x23, 0x03, 0, 0, 0, 0, 0}), milliseconds(1)});
  REQUIRE(image.drive(2).emergency);
  CHECK(image.drive(2).emergency->error_code == 0x2310);
  image.on_frame({frame(0x83, {0, 0, 0, 0, 0, 0, 0, 0}), milliseconds(2)});
  CHECK_FALSE(image.drive(2).emergency);
}

TEST_CASE("A boot-up message is a restart once restarts are watched for") {
  ProcessImage image(kBus);
  image.on_frame({frame(0x704, {0}), milliseconds(1)});
  image.watch_restarts();
  CHECK_FALSE(image.drive(3).restarted);
  image.on_frame({frame(0x704, {5}), milliseconds(2)});  // a heartbeat: operational
  CHECK_FALSE(image.drive(3).restarted);
  image.on_frame({frame(0x704, {0}), milliseconds(3)});
  CHECK(image.drive(3).restarted);
}

TEST_CASE("A cycle is complete once all have answered its SYNC") {
  ProcessImage image(kBus);
  const auto answer = [&](Time at) {
    for (std::uint16_t node = 1; node <= 6; ++node)
      image.on_frame({frame(static_cast<std::uint16_t>(0x180 + node), {0, 0, 0, 0, 0, 0}), at});
    for (std::uint16_t node = 1; node <= 2; ++node)
      image.on_frame({frame(static_cast<std::uint16_t>(0x280 + node), {0, 0, 0, 0, 0, 0}), at});
    image.on_frame({frame(0x187, {0, 0, 0, 0}), at});
  };
  image.on_frame({frame(0x80, {}), milliseconds(10)});
  answer(milliseconds(11));
  CHECK_FALSE(image.is_complete());  // the gyro is missing
  image.on_frame({frame(0x188, {0xff, 0xff}), milliseconds(12)});
  CHECK(image.is_complete());
  CHECK(image.gyro().rate == -1);
  image.on_frame({frame(0x80, {}), milliseconds(20)});
  CHECK_FALSE(image.is_complete());
}
