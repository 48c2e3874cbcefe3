// Marmotte, a real robot without flippers, and its runs: KENAF_MARMOTTE_DATA names the folder of their dataset.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>

#include "formats/runs/dataset.hpp"
#include "robot/angles.hpp"
#include "rollout/roll_out.hpp"
#include "tests/rollout/exact_runs.hpp"

using namespace kenaf;
using namespace kenaf::rollout;
using test::exact;
using test::flat;

namespace {

// Root mean square of the simulated column less the measured one, where that was measured, in the first `until_s`.
double residual(const runs::Run& real, const runs::Run& simulated, const char* column, double until_s,
                bool angle = false) {
  const auto time = real.column("t_s"), measured = real.column(column), sim = simulated.column(column);
  TimeSeries series;
  for (std::size_t i = 0; i < sim.size(); ++i) {
    series.t_s.push_back(simulated.column("t_s")[i]);
    const double before = series.value.empty() ? sim[i] : series.value.back();
    series.value.push_back(angle ? before + robot::wrap_angle(sim[i] - before) : sim[i]);
  }
  double sum = 0;
  int count = 0;
  for (std::size_t i = 0; i < time.size(); ++i) {
    if (std::isnan(measured[i]) || time[i] - time[0] > until_s) continue;
    const double off = series.at(time[i] - time[0]) - measured[i];
    sum += std::pow(angle ? robot::wrap_angle(off) : off, 2);
    ++count;
  }
  return std::sqrt(sum / count);
}

constexpr double kWhole_s = 10;  // longer than any of the runs

double median(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

}  // namespace

TEST_CASE("Marmotte stands, drives and turns without flippers") {
  const auto robot = physics::load_robot("marmotte");
  CHECK_FALSE(robot.has_flippers());
  CHECK(robot.track_gauge_m() == Approx(0.52));
  Manoeuvre ahead;
  ahead.phases = {{.name = "", .track_mps = {1, 1}, .flipper_rad = {}, .at_most_s = 2, .end = {}}};
  const RollOut straight = roll_out(robot, flat(), ahead, exact());
  CHECK(straight.fault.empty());
  CHECK(straight.run.column("z_m").front() == Approx(0.175).margin(1e-3));  // axles 0.129 m up, 0.046 m below B
  // a lag of 0.1 s: 2 - 0.1; friction of 0.8 g lets the robot follow at 7.8 m/s², and it needs 1 / 0.1 at first
  CHECK(straight.run.column("x_m").back() == Approx(1.9).margin(0.02));
}

// The recorded robot turns about 0.96 of what tracks 0.592723 m apart would turn it without slip
// (docs/gap-marmotte.md); the tracks' length of the description was chosen by that.
TEST_CASE("Marmotte turns as far as the recorded robot, on the spot and while it drives") {
  constexpr double kEffectiveWidth_m = 0.592723, kRecorded = 0.96;
  const auto robot = physics::load_robot("marmotte");
  for (const auto& tracks : {std::array{-0.2, 0.2}, {-0.5, 0.5}, {0.0, 0.5}, {0.3, 0.5}}) {
    CAPTURE(tracks[0], tracks[1]);
    Manoeuvre turn;
    turn.phases = {{.name = "", .track_mps = {tracks[0], tracks[1]}, .flipper_rad = {}, .at_most_s = 3, .end = {}}};
    const runs::Run run = roll_out(robot, flat(), turn, exact()).run;
    const auto time = run.column("t_s"), yaw = run.column("yaw_rad");
    const auto left = run.column("track_left_m"), right = run.column("track_right_m");
    const auto from = static_cast<std::size_t>(std::ranges::lower_bound(time, 1.0) - time.begin());
    double turned = 0;
    for (std::size_t i = from + 1; i < time.size(); ++i) turned += robot::wrap_angle(yaw[i] - yaw[i - 1]);
    const double without_slip = (right.back() - right[from] - left.back() + left[from]) / kEffectiveWidth_m;
    CHECK(turned / without_slip == Approx(kRecorded).margin(0.01));
  }
}

TEST_CASE("Marmotte's runs are replayed by their commands and by their measured tracks") {
  const char* folder = std::getenv("KENAF_MARMOTTE_DATA");
  if (folder == nullptr) {
    WARN("skipped: KENAF_MARMOTTE_DATA does not name the folder of Marmotte's runs");
    return;
  }
  const runs::Dataset dataset = runs::read_dataset(folder);
  CHECK(dataset.robot == "marmotte");
  const auto robot = physics::load_robot(dataset.robot);
  const auto world = flat();
  REQUIRE(dataset.runs.size() == 120);
  int moving = 0;
  std::vector<double> speed, yaw, measured_speed, measured_yaw;
  for (std::size_t i = 0; i < dataset.runs.size(); i += 12) {  // a few say it; each has one step of the two speeds
    const std::string& file = dataset.runs[i].file;
    INFO(file);
    const runs::Run run = runs::read_run(std::filesystem::path(folder) / file);
    const Manoeuvre commands = replay_of(run, file), measured = replay_measured_of(run, file);
    moving += commands.start->motion.has_value();
    const RollOut by_commands = roll_out(robot, world, commands, exact());
    const RollOut by_tracks = roll_out(robot, world, measured, exact());
    CHECK(by_commands.fault.empty());
    CHECK(by_tracks.fault.empty());
    if (commands.start->motion)
      CHECK(by_commands.run.column("track_left_mps")[0] == Approx(run.column("track_left_mps")[0]).margin(1e-9));
    for (const char* column : {"track_left_mps", "track_right_mps"}) {
      speed.push_back(residual(run, by_commands.run, column, kWhole_s));
      measured_speed.push_back(residual(run, by_tracks.run, column, kWhole_s));
    }
    yaw.push_back(residual(run, by_commands.run, "yaw_rad", 1, true));
    measured_yaw.push_back(residual(run, by_tracks.run, "yaw_rad", 1, true));
  }
  CAPTURE(median(speed), median(measured_speed), median(yaw), median(measured_yaw));
  CHECK(moving > 7);  // most begin in the step before theirs
  // belts that follow the measured speed differ by what the rows' times are off the multiples of 0.01 s
  CHECK(median(measured_speed) < 0.01);
  CHECK(median(speed) > 5 * median(measured_speed));
  CHECK(median(speed) < 0.3);
  // Units, signs and sides are right: in 1 s these runs turn by about 1 rad, and with the sides swapped yaw would be
  // off by twice that. What is left is a turn's slip.
  CHECK(median(yaw) < 0.4);
  CHECK(median(measured_yaw) < 0.4);
}
