// A suspend, told from clocks that a busy computer reads late. The monotonic clock begins at 100 s; the boot clock is
// 20 s ahead, of a suspend long before.
#include "can/canbus/suspend_watch.hpp"

#include <catch2/catch.hpp>
#include <ctime>

using namespace kenaf::canbus;
using namespace std::chrono_literals;
using Time = kenaf::canopen::Time;

TEST_CASE("A computer that runs was never suspended, however late its clocks are read") {
  SuspendWatch watch;
  CHECK(suspended_since(watch, 100s, 120s, 100s) == Time(0));
  CHECK(suspended_since(watch, 101s, 121s + 1us, 101s + 2us) == Time(0));
  // waits for a processor: before the boot clock is read, and after it
  CHECK(suspended_since(watch, 102s, 122s + 300ms, 102s + 300ms) == Time(0));
  CHECK(suspended_since(watch, 103s, 123s, 103s + 300ms) == Time(0));
}

TEST_CASE("A first look that was held up does not hide a later suspend for long") {
  SuspendWatch watch;
  // 300 ms between the first two: the lead is 20 s, but could be up to 20.3 s
  CHECK(suspended_since(watch, 100s, 120s + 300ms, 100s + 300ms) == Time(0));
  CHECK(suspended_since(watch, 101s, 121s, 101s) == Time(0));  // now it is known to be 20 s
  CHECK(suspended_since(watch, 102s, 122s + 50ms, 102s) == Time(50ms));
}

TEST_CASE("A suspend shows at the first look after it, and stays counted") {
  SuspendWatch watch;
  CHECK(suspended_since(watch, 100s, 120s, 100s) == Time(0));
  // 2 s of sleep between two looks; then between two readings of one look, where 1 ms could be a wait
  CHECK(suspended_since(watch, 100s + 10ms, 122s + 10ms, 100s + 10ms) == Time(2s));
  CHECK(suspended_since(watch, 100s + 20ms, 125s + 20ms, 100s + 21ms) == Time(4s + 999ms));
  CHECK(suspended_since(watch, 100s + 30ms, 125s + 30ms, 100s + 30ms) == Time(5s));
  CHECK(suspended_since(watch, 100s + 40ms, 125s + 40ms, 100s + 90ms) == Time(5s));
}

TEST_CASE("The kernel's clocks read in turn show no suspend") {
  const auto read = [](clockid_t clock) {
    timespec at{};
    REQUIRE(clock_gettime(clock, &at) == 0);
    return Time(std::chrono::seconds(at.tv_sec)) + Time(at.tv_nsec);
  };
  SuspendWatch watch;
  for (int i = 0; i < 10'000; ++i) {
    const Time before = read(CLOCK_MONOTONIC), boot = read(CLOCK_BOOTTIME), after = read(CLOCK_MONOTONIC);
    REQUIRE(suspended_since(watch, before, boot, after) == Time(0));
  }
}
