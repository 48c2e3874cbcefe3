// Inclinometer and gyro: what their numbers mean. Node 7: roll along its lateral axis, pitch along its longitudinal
// axis turned round and mounted 0.1 rad off. Node 8: 16 bits from bit 16, 1000 for 1 rad/s.
#include <catch2/catch.hpp>

#include "tests/can/candrives/easy_robot.hpp"

using namespace kenaf;
using namespace kenaf::candrives;

namespace {

class Tilted final : public Plant {
 public:
  void advance(canopen::Time, const PlantCommand&) override {}
  const PlantState& state() const override { return tilt; }
  PlantState tilt;
};

struct TiltedRobot {
  Tilted plant;
  RobotSlaves slaves;
  int now_ms = 0;

  TiltedRobot() : slaves(easy_robot(), plant, canopen::Time::zero()) { tilt(0, 0, 0); }
  void tilt(double roll_rad, double pitch_rad, double yaw_rate_radps) {
    plant.tilt.roll_rad = roll_rad;
    plant.tilt.pitch_rad = pitch_rad;
    plant.tilt.yaw_rate_radps = yaw_rate_radps;
    Frames out;
    slaves.on_time(std::chrono::milliseconds(++now_ms), out);
  }
  Lines send(const char* line) {
    Frames out;
    slaves.on_frame(frame(line), std::chrono::milliseconds(now_ms), out);
    return texts(out);
  }
};

}  // namespace

TEST_CASE("Slopes are told in hundredths of a degree, with 16 and 32 bits", "[sensor]") {
  TiltedRobot robot;
  robot.tilt(0.2, -0.3, 0);
  // longitudinal = -(pitch + 0.1) = 0.2 rad = 11.459 deg = 1146 = 0x047a; lateral = roll = 0.2 rad
  CHECK(robot.send("607#4010600000000000") == Lines{"587#4B1060007A040000"});
  CHECK(robot.send("607#4020600000000000") == Lines{"587#4B2060007A040000"});
  robot.tilt(-0.2, 0, 0);
  CHECK(robot.send("607#4020600000000000") == Lines{"587#4B20600086FB0000"});  // -1146
  CHECK(robot.send("607#4020610000000000") == Lines{"587#4320610086FBFFFF"});
  SECTION("in thousandths: 11459 = 0x2cc3; what 16 bits cannot hold stays at their end") {
    CHECK(robot.send("607#2B00600001000000") == Lines{"587#6000600000000000"});
    robot.tilt(0.2, 0, 0);
    CHECK(robot.send("607#4020600000000000") == Lines{"587#4B206000C32C0000"});
    robot.tilt(1.0, 0, 0);  // 57296 = 0xdfd0
    CHECK(robot.send("607#4020600000000000") == Lines{"587#4B206000FF7F0000"});
    CHECK(robot.send("607#4020610000000000") == Lines{"587#43206100D0DF0000"});
    CHECK(robot.send("607#2B00600007000000") == Lines{"587#8000600030000906"});  // no such resolution
  }
}

TEST_CASE("The gyro's PDO holds the yaw rate at its bits, at each SYNC", "[sensor]") {
  TiltedRobot robot;
  robot.send("000#0108");
  robot.tilt(0, 0, 1.5);  // to the left: 1500 = 0x05dc
  CHECK(robot.send("080#") == Lines{"188#0000DC05"});
  robot.tilt(0, 0, -1.5);
  CHECK(robot.send("080#") == Lines{"188#000024FA"});
  robot.tilt(0, 0, 100);  // more than it can hold
  CHECK(robot.send("080#") == Lines{"188#0000FF7F"});
}

TEST_CASE("Bits of a gyro need not begin or end with a byte", "[sensor]") {
  canbus::RobotBus bus = easy_robot();
  bus.gyro = canbus::GyroOnBus{8, 2, 4, 12, -1000.0};
  Tilted plant;
  RobotSlaves slaves(bus, plant, canopen::Time::zero());
  plant.tilt.yaw_rate_radps = 0.5;  // -500 = 0xe0c of 12 bits, from bit 4: 0xe0c0
  Frames out;
  slaves.on_time(std::chrono::milliseconds(1), out);
  out.clear();
  slaves.on_frame(frame("000#0108"), std::chrono::milliseconds(1), out);
  slaves.on_frame(frame("080#"), std::chrono::milliseconds(1), out);
  CHECK(texts(out) == Lines{"288#C0E0"});
}
