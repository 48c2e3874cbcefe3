// Motion: ramps and profiles on their own, and in the drive's modes. Node 1 is a track, node 3 a flipper; both have
// 10000 counts for 1 m or 1 rad, and the plant follows its commands exactly, so 0x6064 is what the drive demands.
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/can/candrives/easy_robot.hpp"

using namespace kenaf;
using namespace kenaf::candrives;

namespace {

constexpr int kProfilePosition = 1, kProfileVelocity = 3, kCyclicPosition = 8, kCyclicVelocity = 9;
constexpr std::int64_t kTargetReached = 1 << 10, kInternalLimit = 1 << 11, kAcknowledged = 1 << 12;

// Steps of 1 ms until `done`, at most 10 s.
template <typename Done>
int steps_until(Done done) {
  int steps = 0;
  while (!done() && steps < 10'000) ++steps;
  return steps;
}

struct Axis {
  EasyRobot robot;
  canopen::NodeId node;

  Axis(canopen::NodeId of, int mode) : node(of) {
    robot.write(node, 0x6083, 0, 4, 10'000);  // acceleration, counts/s^2
    robot.write(node, 0x6084, 0, 4, 5'000);   // deceleration
    robot.write(node, 0x6081, 0, 4, 5'000);   // profile velocity, counts/s
    robot.enable(node, mode);
  }
  std::int64_t position() { return robot.value(node, 0x6064); }
  std::int64_t velocity() { return robot.value(node, 0x606c); }
  std::int64_t status() { return robot.value(node, 0x6041); }
  void control(int word) { robot.write(node, 0x6040, 0, 2, word); }
  void target(std::int64_t position) { robot.write(node, 0x607a, 0, 4, position); }
  void speed(std::int64_t velocity) { robot.write(node, 0x60ff, 0, 4, velocity); }
};

}  // namespace

TEST_CASE("A trapezoid takes the time of its three parts, and ends exactly at its target", "[profile]") {
  // D / v + v / 2 (1/a + 1/d): 10000/5000 + 2500 (1/10000 + 1/5000) = 2.75 s; a step or two more where parts do not end
  // with a step
  const Ramps ramps{10'000, 5'000};
  Demand demand;
  double fastest = 0;
  const int steps = steps_until([&] {
    fastest = std::max(fastest, demand.velocity);
    return move_to_position(demand, 10'000, 5'000, ramps, 0.001);
  });
  CHECK(steps >= 2749);
  CHECK(steps <= 2753);
  CHECK(fastest == 5'000);
  CHECK(demand.position == 10'000);
  CHECK(demand.velocity == 0);
}

TEST_CASE("A short way is a triangle", "[profile]") {
  // the top speed v has v^2/2 (1/a + 1/d) = D: sqrt(2 * 300 / 0.0003) = 1414 counts/s, in 1414 * 0.0003 = 0.424 s
  const Ramps ramps{10'000, 5'000};
  Demand demand;
  double fastest = 0;
  const int steps = steps_until([&] {
    fastest = std::max(fastest, -demand.velocity);
    return move_to_position(demand, -300, 5'000, ramps, 0.001);
  });
  CHECK(fastest == Approx(1414).margin(10));  // one step of acceleration
  CHECK(steps == Approx(424).margin(3));
  CHECK(demand.position == -300);
}

TEST_CASE("A target that is too near is passed, by the braking distance, and come back to", "[profile]") {
  Demand demand{0, 1000};
  const Ramps ramps{10'000, 5'000};
  double furthest = 0;
  steps_until([&] {
    furthest = std::max(furthest, demand.position);
    return move_to_position(demand, 50, 5'000, ramps, 0.001);
  });
  CHECK(furthest == Approx(100));  // 1000^2 / (2 * 5000)
  CHECK(demand.position == 50);
}

TEST_CASE("Profile velocity: a ramp up takes v/a and v^2/2a, and the target is reached at its end", "[profile]") {
  Axis track(1, kProfileVelocity);
  track.speed(5000);
  track.robot.wait(499);
  CHECK(track.velocity() == 4990);
  CHECK((track.status() & kTargetReached) == 0);
  track.robot.wait(1);
  CHECK(track.velocity() == 5000);
  // 5000^2 / (2 * 10000); a track turns each step at the speed of its end: half of 5000 counts/s * 1 ms more
  CHECK(track.position() == Approx(1250 + 2.5).margin(1));
  CHECK((track.status() & kTargetReached) != 0);
  CHECK(track.robot.plant.state().track_mps[0] == Approx(0.5));
  SECTION("a new speed of the other sign passes standstill: down on 6084, up on 6083") {
    track.speed(-2000);
    track.robot.wait(1000);  // 5000 / 5000
    CHECK(track.velocity() == 0);
    track.robot.wait(200);  // 2000 / 10000
    CHECK(track.velocity() == -2000);
  }
  SECTION("halt, bit 8, slows down on 6084: 1 s, 2500 counts") {
    track.control(0x010f);
    track.robot.wait(1000);
    CHECK(track.velocity() == 0);
    CHECK(track.position() == Approx(1250 + 2500).margin(1));
    CHECK((track.status() & kTargetReached) != 0);
    track.control(0x000f);
    track.robot.wait(500);
    CHECK(track.velocity() == 5000);
  }
  SECTION("max profile velocity, 607f, bounds it, and the statusword says so") {
    track.robot.write(1, 0x607f, 0, 4, 3000);
    track.robot.wait(400);  // 2000 / 5000
    CHECK(track.velocity() == 3000);
    CHECK((track.status() & kInternalLimit) != 0);
    CHECK((track.status() & kTargetReached) == 0);
  }
}

TEST_CASE("Directions and counts of a drive are its own", "[profile]") {
  Axis right(2, kProfileVelocity);  // direction -1
  right.speed(5000);
  right.robot.wait(600);
  CHECK(right.robot.plant.state().track_mps[1] == Approx(-0.5));
  CHECK(right.velocity() == 5000);
  CHECK(right.position() == Approx(1250 + 2.5 + 500).margin(1));
}

TEST_CASE("Profile position: the set-point handshake hands a target over", "[profile]") {
  Axis flipper(3, kProfilePosition);
  flipper.target(2500);
  flipper.robot.wait(100);
  CHECK(flipper.position() == 0);  // a target alone moves nothing
  flipper.control(0x001f);         // new set-point
  CHECK((flipper.status() & kAcknowledged) != 0);
  CHECK((flipper.status() & kTargetReached) == 0);
  flipper.robot.wait(100);
  CHECK(flipper.velocity() == 995);  // of the plant: the mean of the last step
  flipper.control(0x000f);
  CHECK((flipper.status() & kAcknowledged) == 0);

  SECTION("it goes there: triangle of sqrt(2 * 2500 / 0.0003) = 4082 counts/s, 1.225 s") {
    flipper.robot.wait(1120);
    CHECK((flipper.status() & kTargetReached) == 0);
    flipper.robot.wait(10);
    CHECK(flipper.position() == 2500);
    CHECK((flipper.status() & kTargetReached) != 0);
    CHECK(flipper.robot.plant.state().flipper_rad[0] == Approx(0.25));
  }
  SECTION("change at once, bit 5: the newer target replaces the one under way") {
    flipper.target(-300);
    flipper.control(0x003f);
    flipper.robot.wait(2000);
    CHECK(flipper.position() == -300);
  }
  SECTION("without bit 5 it waits its turn, and a third is not acknowledged until there is room") {
    flipper.target(3000);
    flipper.control(0x001f);
    flipper.control(0x000f);
    CHECK((flipper.status() & kAcknowledged) != 0);  // the buffer is full
    flipper.target(100);
    flipper.control(0x001f);
    flipper.control(0x000f);
    flipper.robot.wait(1130);
    CHECK(flipper.position() >= 2500);
    CHECK((flipper.status() & kAcknowledged) == 0);
    flipper.robot.wait(2000);
    CHECK(flipper.position() == 3000);
  }
  SECTION("relative, bit 6: counted from the target before") {
    flipper.robot.wait(2000);
    flipper.target(-500);
    flipper.control(0x005f);
    flipper.robot.wait(2000);
    CHECK(flipper.position() == 2000);
  }
}

TEST_CASE("Software limits, 607d, hold a target back, and the statusword says so", "[profile]") {
  SECTION("profile position") {
    Axis flipper(3, kProfilePosition);
    flipper.robot.write(3, 0x607d, 1, 4, -1000);
    flipper.robot.write(3, 0x607d, 2, 4, 1000);
    flipper.target(2500);
    flipper.control(0x001f);
    flipper.robot.wait(3000);
    CHECK(flipper.position() == 1000);
    CHECK((flipper.status() & kInternalLimit) != 0);
  }
  for (const int mode : {kProfileVelocity, kCyclicVelocity}) {
    Axis flipper(3, mode);
    flipper.robot.write(3, 0x607d, 1, 4, -1000);
    flipper.robot.write(3, 0x607d, 2, 4, 1000);
    flipper.speed(500);
    flipper.robot.wait(4000);
    CHECK(flipper.position() == 1000);
    CHECK((flipper.status() & kInternalLimit) != 0);
    flipper.speed(-500);
    flipper.robot.wait(1000);
    CHECK(flipper.position() < 600);
  }
}

TEST_CASE("Cyclic velocity follows at once", "[profile]") {
  Axis track(1, kCyclicVelocity);
  track.speed(4000);
  track.robot.wait(1);
  CHECK(track.velocity() == 4000);
  CHECK((track.status() & kAcknowledged) != 0);  // bit 12: follows the command
  track.speed(0);
  track.robot.wait(1);
  CHECK(track.velocity() == 0);
  CHECK(track.position() == 4);
}

TEST_CASE("Cyclic position goes evenly to each target within the interpolation period", "[profile]") {
  Axis flipper(3, kCyclicPosition);
  flipper.robot.write(3, 0x60c2, 1, 1, 10);  // 10 * 10^-3 s
  flipper.robot.write(3, 0x60c2, 2, 1, -3);
  flipper.target(100);
  flipper.robot.wait(5);
  CHECK(flipper.position() == 50);
  CHECK(flipper.velocity() == 10'000);
  flipper.robot.wait(5);
  CHECK(flipper.position() == 100);
  flipper.robot.wait(5);
  CHECK(flipper.velocity() == 0);
  // further than max profile velocity, 50000 counts/s, allows: 1000 counts take 20 ms
  flipper.target(1100);
  flipper.robot.wait(10);
  CHECK(flipper.position() == 600);
  CHECK((flipper.status() & kInternalLimit) != 0);
  flipper.robot.wait(10);
  CHECK(flipper.position() == 1100);
}

TEST_CASE("Another mode takes over from the speed there is", "[profile]") {
  Axis track(1, kProfileVelocity);
  track.speed(5000);
  track.robot.wait(600);
  track.robot.write(1, 0x6060, 0, 1, kProfilePosition);
  track.robot.wait(1);
  CHECK(track.robot.value(1, 0x6061) == kProfilePosition);
  CHECK(track.velocity() > 4900);
  track.robot.wait(1100);                 // down on 6084, for there is no set-point: 1 s
  CHECK(std::abs(track.velocity()) < 5);  // the position loop settles
}
