// Counters of travel that wrap: named with row and modulus, unwrapped on request.
#include "gap/logs/wrapped_travel.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "gap/logs/plausibility.hpp"
#include "tests/gap/made_run.hpp"

using namespace kenaf;

namespace {

// 10 s forward at 0.3 m/s, then back at 0.25 m/s for 4 s, in rows of 0.05 s; the left counter counts from -0.5 to 0.5
// m. Forward it reaches 0.5 at 1.667 s, 1.5 m at 5 s, 2.5 m at 8.333 s; back, from 3 m, 2.5 m at 12 s.
double way_m(double t_s) {
  return t_s < 10 ? 0.3 * t_s : 3 - 0.25 * (t_s - 10);
}

runs::Run there_and_back(bool speeds) {
  const auto speed = [](double t_s) { return t_s < 10 ? 0.3 : -0.25; };
  const auto wrapped = [](double t_s) { return std::remainder(way_m(t_s) - 1e-9, 1.0); };
  runs::Run run = test::made_run(14, 0.05,
                                 {{"cmd_track_left_mps", speed},
                                  {"cmd_track_right_mps", speed},
                                  {"track_left_m", wrapped},
                                  {"track_right_m", way_m}});
  for (const char* name : {"track_left_mps", "track_right_mps"}) {
    if (!speeds) break;
    run.columns.push_back(name);
    run.values.emplace_back();
    for (const double t_s : run.values[0]) run.values.back().push_back(speed(t_s));
  }
  return run;
}

}  // namespace

TEST_CASE("A counter that wraps is found with its rows and modulus, by the speed or by the steps beside") {
  for (const bool speeds : {true, false}) {
    const runs::Run run = there_and_back(speeds);
    const auto wrapped =
        gap::logs::wrapped_travel(run.column("t_s"), run.column("track_left_m"), run.column("track_left_mps"));
    REQUIRE(wrapped);
    // rows of 0.05 s: the first after 1.667 s is 34, after 5 s 101, after 8.333 s 167; back below 2.5 m is row 240
    CHECK(wrapped->rows == std::vector<std::size_t>{34, 101, 167, 240});
    CHECK(wrapped->sign == std::vector<int>{-1, -1, -1, 1});
    CHECK(wrapped->modulus_m == Approx(1).epsilon(0.001));
    CHECK_FALSE(
        gap::logs::wrapped_travel(run.column("t_s"), run.column("track_right_m"), run.column("track_right_mps")));
  }
}

TEST_CASE("The check names column, line and modulus of a counter that wraps, and what to do") {
  std::string text;
  for (const auto& finding : gap::logs::check_run(there_and_back(true), "run.csv", nullptr))
    if (finding.severity == gap::logs::Finding::Severity::refuse) text += in_words(finding) + "\n";
  // line 1 is the header: row 34 is line 36, 0.3 m/s times 1.7 s less a metre
  CHECK(text ==
        "run.csv:36: track_left_m: jumps by 1 m, 4 times, while the track goes on, here to -0.49 m: its counter wraps, "
        "or was set back; kenaf-gap merge and kenaf-gap dataset unwrap it with --unwrap\n");
}

TEST_CASE("Unwrapped travel goes on, also across empty cells, and another run stays as it is") {
  runs::Run run = there_and_back(true);
  run.values[3][100] = std::nan("");
  run.values[3][101] = std::nan("");
  CHECK(gap::logs::unwrap_travel(run) == std::vector<std::string>{"track_left_m: unwrapped 4 times by 1 m"});
  for (std::size_t row = 0; row < run.row_count(); ++row) {
    if (row == 100 || row == 101) continue;
    CHECK(run.column("track_left_m")[row] == Approx(way_m(run.column("t_s")[row])).epsilon(0).margin(1e-6));
  }
  CHECK(gap::logs::unwrap_travel(run).empty());
}

TEST_CASE("Jumps of different lengths, noise and whole counts are no wrapping counter") {
  runs::Run run = there_and_back(true);
  for (std::size_t row = 200; row < run.row_count(); ++row) run.values[3][row] += 0.3;
  CHECK(gap::logs::unwrap_travel(run).empty());
  runs::Run counts = there_and_back(true);
  for (double& travel : counts.values[4]) travel = 0.04 * std::round(travel / 0.04);
  CHECK_FALSE(gap::logs::wrapped_travel(counts.column("t_s"), counts.column("track_right_m"),
                                        counts.column("track_right_mps")));
}
