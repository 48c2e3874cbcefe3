#include "server/world_server/clock.hpp"

#include <catch2/catch.hpp>
#include <cmath>

namespace kenaf::world_server {

namespace {

// Steps that fall due when `wall_s` passes in ticks of a millisecond.
int steps_in(Clock& clock, double& now_s, double wall_s) {
  int steps = 0;
  const long ticks = std::lround(wall_s * 1000);
  for (long i = 0; i < ticks; ++i) {
    now_s += 0.001;
    clock.pass(now_s);
    for (; clock.step_due(); ++steps) clock.stepped();
  }
  return steps;
}

}  // namespace

TEST_CASE("Robot time passes as many times as fast as it is asked to") {
  double now_s = 1000;
  Clock clock(0.001, 1);
  clock.pass(now_s);
  CHECK(steps_in(clock, now_s, 2) == Approx(2000).margin(1));
  clock.set_speed(0.5);
  CHECK(steps_in(clock, now_s, 2) == Approx(1000).margin(1));
  clock.set_speed(4);
  CHECK(steps_in(clock, now_s, 2) == Approx(8000).margin(1));
}

TEST_CASE("The first call of the clock owes no time, however late it comes") {
  Clock clock(0.001, 1);
  CHECK(clock.pass(123456) == 0);
  CHECK_FALSE(clock.step_due());
}

TEST_CASE("A clock without limit is always due") {
  Clock clock(0.001, 0);
  clock.pass(5);
  for (int i = 0; i < 1000; ++i) {
    CHECK(clock.step_due());
    clock.stepped();
  }
}

TEST_CASE("At most a tenth of a second is caught up, the rest is dropped and said") {
  Clock clock(0.001, 2);
  clock.pass(0);
  // 1 s of wall-clock time is 2 s of robot time; 0.1 s x 2 may be caught up.
  CHECK(clock.pass(1) == Approx(1.8));
  int steps = 0;
  for (; clock.step_due(); ++steps) clock.stepped();
  CHECK(steps == Approx(200).margin(1));
}

TEST_CASE("A paused clock is never due and owes nothing afterwards") {
  Clock clock(0.001, 1);
  clock.pass(0);
  clock.set_paused(true);
  CHECK(clock.pass(10) == 0);
  CHECK_FALSE(clock.step_due());
  clock.set_paused(false);
  clock.pass(10.0005);
  CHECK_FALSE(clock.step_due());
  clock.pass(10.001);
  CHECK(clock.step_due());
}

TEST_CASE("The clock says when the next step falls due") {
  Clock clock(0.002, 0.5);
  clock.pass(7);
  // 2 ms of robot time take 4 ms at half speed; 1 ms of them has passed.
  clock.pass(7.001);
  CHECK(clock.step_wall_s(1) == Approx(7.004));
  CHECK(clock.step_wall_s(3) == Approx(7.012));
}

TEST_CASE("A very slow clock still gets to its next step") {
  Clock clock(0.001, 0.001);
  clock.pass(0);
  clock.pass(0.5);
  CHECK_FALSE(clock.step_due());
  clock.pass(1.0);
  CHECK(clock.step_due());
}

}  // namespace kenaf::world_server
