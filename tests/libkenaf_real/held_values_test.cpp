// Which values of a cycle were measured in it, and which are held from before: by what has come on the bus.
#include <catch2/catch.hpp>

#include "tests/libkenaf_real/robot_on_bus.hpp"

using namespace kenaf;
using namespace kenaf::real;

namespace {

struct News {
  int encoders = 0, flippers = 0, track_currents = 0, flipper_currents = 0, battery = 0, posture = 0;
};

News news_of(RobotOnBus& robot, int cycles) {
  News news;
  for (int i = 0; i < cycles; ++i) {
    const std::uint32_t fields = robot.run(1, robot::Command{}).fields;
    const auto count = [&](robot::StateField field) { return robot::is_new(fields, field) ? 1 : 0; };
    news.encoders += count(robot::kHasEncoders);
    news.flippers += count(robot::kHasFlippers);
    news.track_currents += count(robot::kHasCurrents);
    news.flipper_currents += (fields & robot::kHeldFlipperCurrents) == 0 ? count(robot::kHasCurrents) : 0;
    news.battery += count(robot::kHasBattery);
    news.posture += count(robot::kHasPosture);
    // held or new, it is there
    CHECK((fields & robot::kHasBattery) != 0);
    CHECK((fields & robot::kHasCurrents) != 0);
  }
  return news;
}

}  // namespace

TEST_CASE("The battery is new each 10th cycle, flippers' currents each 5th, all else in each") {
  RobotOnBus robot;
  robot.open();
  const News news = news_of(robot, 40);
  CHECK(news.battery == 4);
  CHECK(news.flipper_currents == 8);
  CHECK(news.track_currents == 40);
  CHECK(news.encoders == 40);
  CHECK(news.flippers == 40);
  CHECK(news.posture == 40);
}

TEST_CASE("What a lost frame should have brought is held") {
  RobotOnBus robot;
  robot.open();
  int left = 3;  // frames of node 1 with its position, which are lost
  robot.wire.alter = [&](canopen::Frame& frame, candrives::Sender sender) {
    return sender != candrives::Sender::slaves || frame.id != 0x181 || left-- <= 0;
  };
  const News news = news_of(robot, 40);
  CHECK(news.encoders == 37);
  CHECK(news.flippers == 40);
  CHECK(news.track_currents == 40);
}
