// Times of frames from a wall clock that somebody sets. `now` counts from 0, the wall clock began at 1000 s.
#include "can/canbus/wall_clock.hpp"

#include <catch2/catch.hpp>

using namespace kenaf::canbus;
using namespace std::chrono_literals;
using Time = kenaf::canopen::Time;

TEST_CASE("A frame was received as long ago as its stamp is old") {
  WallClock clock;
  CHECK(received_at(clock, 1000s + 40ms, 1000s + 50ms, 50ms) == Time(40ms));
  // a clock that runs faster, by 0.5 ms in a second, was not set
  CHECK(received_at(clock, 1001s + 40ms, 1001s + 50ms + 500us, 1050ms) == Time(1039ms + 500us));
}

TEST_CASE("A stamp that cannot be is as good as none") {
  WallClock clock;
  CHECK(received_at(clock, 1000s + 60ms, 1000s + 50ms, 50ms) == Time(50ms));
  CHECK(received_at(clock, 998s, 1000s + 60ms, 60ms) == Time(60ms));
}

TEST_CASE("Frames from before the clock was set have no age, those after it have theirs again") {
  for (const auto step : {Time(200ms), Time(-200ms), Time(20ms)}) {
    WallClock clock;
    CHECK(received_at(clock, 1000s + 9ms, 1000s + 10ms, 10ms) == Time(9ms));
    // set between 10 and 20 ms; two frames of 11 and 12 ms, stamped before, wait in the socket
    CHECK(received_at(clock, 1000s + 11ms, 1000s + 20ms + step, 20ms) == Time(20ms));
    CHECK(received_at(clock, 1000s + 12ms, 1000s + 21ms + step, 21ms) == Time(21ms));
    // 0.3 s later the step is over, also for a frame that waited for 150 ms
    CHECK(received_at(clock, 1000s + 319ms + step, 1000s + 320ms + step, 320ms) == Time(319ms));
    CHECK(received_at(clock, 1000s + 180ms + step, 1000s + 330ms + step, 330ms) == Time(180ms));
  }
}
