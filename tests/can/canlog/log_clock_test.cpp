// The times of a log: intervals, missing times, and a clock that is set back.
#include <catch2/catch.hpp>

#include "can/canlog/figures.hpp"
#include "tests/can/canlog/lines.hpp"

using namespace kenaf;
using namespace kenaf::canlog;
using namespace std::chrono_literals;

namespace {

std::vector<std::int64_t> ms_of(const Log& log) {
  std::vector<std::int64_t> times;
  for (const LogFrame& frame : log.frames) times.push_back(frame.at / 1ms);
  return times;
}

using Times = std::vector<std::int64_t>;

}  // namespace

TEST_CASE("Intervals are summed up, times since the first frame are not") {
  const Log intervals =
      log_from("(000.000000) can0 080#\n(000.010000) can0 080#\n(000.010000) can0 080#\n(000.010000) can0 080#\n");
  CHECK(intervals.summed_times);
  CHECK(ms_of(intervals) == Times{0, 10, 20, 30});
  CHECK(*figures_of(intervals, easy_network()).period_s == Approx(0.010));

  const Log since_first = log_from("(000.000000) can0 080#\n(000.010000) can0 080#\n(000.020000) can0 080#\n");
  CHECK_FALSE(since_first.summed_times);
  CHECK(ms_of(since_first) == Times{0, 10, 20});

  // two frames within one microsecond
  const Log burst = log_from(
      "(000.000000) can0 080#\n(000.010000) can0 080#\n(000.010000) can0 081#0000000000000000\n"
      "(000.020000) can0 080#\n(000.030000) can0 080#\n(000.040000) can0 080#\n");
  CHECK_FALSE(burst.summed_times);
  // an interval counts from the line before, of another interface too: 0, 3, 3 + 7, 10 + 3
  const Log two =
      log_from("(000.000000) can0 080#\n(000.003000) can1 080#\n(000.007000) can0 080#\n(000.003000) can0 080#\n");
  CHECK(ms_of(two) == Times{0, 10, 13});
  // written with all digits, they are times of a clock
  CHECK_FALSE(log_from("(0000000010.000000) can0 080#\n(0000000010.000000) can0 080#\n").summed_times);
}

TEST_CASE("A clock that steps back is named, and the log's time stands still over it") {
  const Log log = log_from(
      "(1700000010.000000) can0 080#\n(1700000010.010000) can0 080#\n"
      "(1700000003.020000) can0 080#\n(1700000003.030000) can0 080#\n");
  REQUIRE(log.clock_steps.size() == 1);
  CHECK(log.clock_steps[0].line == 3);
  CHECK(log.clock_steps[0].back == 6990ms);
  CHECK(log.frames[2].at == log.frames[1].at);
  CHECK(log.frames[3].at - log.frames[0].at == 20ms);

  // Four SYNCs of 51 bits. Two intervals of 10 ms, none over the step, and the two frames that fill 20 ms.
  const Figures figures = figures_of(log, easy_network());
  CHECK(*figures.period_s == Approx(0.010));
  CHECK(figures.sync_jitter->max_s == Approx(0).margin(1e-12));
  CHECK(figures.gaps == 0);
  CHECK(figures.all.frames == 2);
  CHECK(figures.all.bits_per_s == Approx(2 * 51 / 0.020));
  CHECK_THAT(to_text(figures, 500e3), Catch::Contains("steps of the clock    1"));
}

TEST_CASE("Lines that are out of order by less than a millisecond are no step") {
  const Log log = log_from("(1.000000) can0 080#\n(1.010500) can0 080#\n(1.010000) can0 080#\n(1.020000) can0 080#\n");
  CHECK(log.clock_steps.empty());
  CHECK(log.frames[2].at == log.frames[1].at);
  CHECK(log.frames[3].at == 1020ms);
}

TEST_CASE("Nothing is judged by time over a step of the clock") {
  // the answer comes, by the clock, 6 s before its request
  const Log log = log_from("(10.000) can0 601#4000100000000000\n(4.000) can0 581#4300100092010200\n");
  CHECK(check_rules(log, easy_network()).empty());
}

TEST_CASE("A log without times is read, and has no figures of time") {
  const Log log = log_from("  can0  080   [0]\n  can0  701   [1]  7F\n(1.0) can0 080#\n");
  CHECK_FALSE(log.has_times);
  CHECK(log.frames.size() == 2);
  CHECK(log.bad_lines.size() == 1);  // the third has a time
  CHECK_THAT(to_text(figures_of(log, easy_network()), 500e3),
             Catch::Contains("2 frames, 1 SYNC; the log has no times"));
}
