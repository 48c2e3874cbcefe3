// What is found in a log that is not what it says, and nothing in one that is right.
#include "gap/logs/plausibility.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <numbers>
#include <random>

#include "physics/world_description.hpp"
#include "rollout/roll_out.hpp"
#include "tests/gap/kenaf_gap.hpp"
#include "tests/gap/made_run.hpp"

using namespace kenaf;
using Severity = gap::logs::Finding::Severity;

namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

const physics::RobotDescription& nominal() {
  static const physics::RobotDescription kenaf = physics::load_robot("kenaf");
  return kenaf;
}

runs::Run driven(const std::string& name, double noise_scale = 1) {
  const rollout::Manoeuvre manoeuvre = rollout::load_manoeuvre(name);
  std::vector<std::string> warnings;
  rollout::RollOutOptions options;
  options.noise_scale = noise_scale;
  options.start_scatter_m = 0.005;
  options.start_scatter_rad = 0.01;
  return rollout::roll_out(nominal(), physics::load_world(manoeuvre.world, warnings), manoeuvre, options).run;
}

// Curves both ways, of 12 s; driven once.
const runs::Run& arc() {
  static const runs::Run run = driven("arc");
  return run;
}
const runs::Run& step() {
  static const runs::Run run = driven("step-150-flippers");
  return run;
}

std::vector<double>& column(runs::Run& run, const std::string& name) {
  const auto found = std::ranges::find(run.columns, name);
  if (found == run.columns.end()) throw std::runtime_error("no column " + name);
  return run.values[static_cast<std::size_t>(found - run.columns.begin())];
}

runs::Run changed(runs::Run run, const std::vector<std::string>& names, const std::function<double(double)>& change) {
  for (const std::string& name : names)
    for (double& value : column(run, name)) value = change(value);
  return run;
}
runs::Run scaled(const runs::Run& run, const std::vector<std::string>& names, double factor) {
  return changed(run, names, [factor](double value) { return factor * value; });
}

std::string words(const std::vector<gap::logs::Finding>& findings) {
  std::string text;
  for (const auto& finding : findings)
    text += (finding.severity != Severity::refuse ? "warning: " : "") + gap::logs::in_words(finding) + "\n";
  return text;
}

std::string found(const runs::Run& run) {
  return words(gap::logs::check_run(run, "run.csv", &nominal()));
}

const std::vector<std::string> kPlace = {"x_m", "y_m", "z_m"}, kAngles = {"roll_rad", "pitch_rad", "yaw_rad"},
                               kGyro = {"gyro_x_radps", "gyro_y_radps", "gyro_z_radps"},
                               kAcceleration = {"acc_x_mps2", "acc_y_mps2", "acc_z_mps2"},
                               kCommands = {"cmd_track_left_mps", "cmd_track_right_mps"},
                               kSpeeds = {"track_left_mps", "track_right_mps"},
                               kTravels = {"track_left_m", "track_right_m"},
                               kFlippers = {"flipper_fl_rad", "flipper_fr_rad", "flipper_rl_rad", "flipper_rr_rad"};

// 4 s of tracks at 0.2 m/s under a robot that goes straight at `speed_mps`.
runs::Run carried(double speed_mps, double pitch_rad) {
  const auto level = [](double) { return 0.0; };
  const auto track = [](double t_s) { return t_s < 0.5 ? 0 : 0.2; };
  const auto way = [speed_mps](double t_s) { return t_s < 0.5 ? 0 : speed_mps * (t_s - 0.5); };
  return test::made_run(4, 0.01,
                        {{"cmd_track_left_mps", track},
                         {"cmd_track_right_mps", track},
                         {"track_left_mps", track},
                         {"track_right_mps", track},
                         {"x_m", way},
                         {"y_m", level},
                         {"z_m", [&](double t_s) { return 1 - std::tan(pitch_rad) * way(t_s); }},
                         {"roll_rad", level},
                         {"pitch_rad", [pitch_rad](double) { return pitch_rad; }},
                         {"yaw_rad", [](double t_s) { return 0.001 * std::sin(t_s); }}});
}

}  // namespace

TEST_CASE("Nothing is found in runs that are right: driving, turning, climbing, falling, failing, standing", "[long]") {
  for (const char* name : {"arc", "drop", "flipper-sweep", "speed-steps", "step-100", "step-200-flippers",
                           "straight-fast", "trench-350", "turn-in-place", "tilted-box"}) {
    INFO(name);
    CHECK(found(driven(name)) == "");
  }
  CHECK(found(driven("arc", 0)) == "");  // sensors without noise are not dead
}

TEST_CASE("Nothing is found either where less is known: no robot, no gyro, no tracks or a pose ten times a second") {
  CHECK(words(gap::logs::check_run(arc(), "run.csv", nullptr)) == "");
  for (const auto& left_out : {kGyro, kAcceleration, kSpeeds, kTravels, kFlippers}) {
    runs::Run run = arc();
    for (const std::string& name : left_out) {
      const auto at = std::ranges::find(run.columns, name) - run.columns.begin();
      run.columns.erase(run.columns.begin() + at);
      run.values.erase(run.values.begin() + at);
    }
    INFO(left_out.front());
    CHECK(found(run) == "");
  }
  runs::Run slow = arc();
  for (const auto& names : {kPlace, kAngles})
    for (const std::string& name : names)
      for (std::size_t i = 0; i < slow.row_count(); ++i)
        if (i % 10 != 0) column(slow, name)[i] = std::nan("");
  CHECK(found(slow) == "");
}

TEST_CASE("Recorded runs of a real robot in a forest have no finding") {
  const char* folder = std::getenv("KENAF_MARMOTTE_DATA");
  if (folder == nullptr) {
    WARN("skipped: KENAF_MARMOTTE_DATA does not name the folder of the recorded runs");
    return;
  }
  const runs::Dataset dataset = runs::read_dataset(folder);
  CHECK(dataset.runs.size() == 120);
  std::vector<runs::Run> recorded;
  for (const auto& run : dataset.runs) recorded.push_back(runs::read_run(std::filesystem::path(folder) / run.file));
  CHECK(words(gap::logs::check_plausibility(dataset, recorded, nullptr)) == "");
}

TEST_CASE("Millimetres and centimetres where metres belong are refused by name") {
  struct Case {
    std::vector<std::string> columns;
    double factor;
    const char* words;
  };
  for (const Case& each : {Case{kPlace, 1000, "x_m: looks like millimetres"},
                           {kPlace, 100, "x_m: looks like centimetres"},
                           {kCommands, 1000, "cmd_track_left_mps: is "},
                           {kSpeeds, 1000, "track_left_mps: is "},
                           {kTravels, 1000, "track_left_m: looks like millimetres"},
                           {kTravels, 100, "track_left_m: looks like centimetres"},
                           {{"track_right_m"}, 1000, "track_right_m: looks like millimetres"},
                           {{"battery_v"}, 1000, "battery_v: is 2.59e+04 V: it looks like millivolts"}}) {
    const auto findings = gap::logs::check_run(scaled(arc(), each.columns, each.factor), "run.csv", &nominal());
    INFO(words(findings));
    CHECK(gap::logs::any_refused(findings));
    CHECK_THAT(words(findings), Catch::Contains(each.words));
    // without a robot's limits too, as one quantity tells the other's unit
    if (each.columns != std::vector<std::string>{"battery_v"})
      CHECK(gap::logs::any_refused(gap::logs::check_run(scaled(arc(), each.columns, each.factor), "run.csv", nullptr)));
  }
}

TEST_CASE("Degrees where radians belong are refused by name, g where m/s2 belong") {
  struct Case {
    const runs::Run& run;
    std::vector<std::string> columns;
    double factor;
    const char* words;
  };
  for (const Case& each : {Case{arc(), {"yaw_rad"}, kDegrees, "yaw_rad: looks like degrees"},
                           {arc(), kAngles, kDegrees, "yaw_rad: looks like degrees"},
                           {step(), kAngles, kDegrees, "pitch_rad: is "},
                           {arc(), kGyro, kDegrees, "gyro_z_radps: "},
                           {step(), kFlippers, kDegrees, "looks like degrees"},
                           {arc(), kAcceleration, 1 / 9.80665, "acc_x_mps2: looks like multiples of g"},
                           {arc(), kAcceleration, 1000, "acc_x_mps2: looks like millimetres"}}) {
    const auto findings = gap::logs::check_run(scaled(each.run, each.columns, each.factor), "run.csv", &nominal());
    INFO(words(findings));
    CHECK(gap::logs::any_refused(findings));
    CHECK_THAT(words(findings), Catch::Contains(each.words));
  }
}

TEST_CASE("Yaw in degrees is seen by the tracks where there is no gyro") {
  runs::Run run = scaled(arc(), {"yaw_rad"}, kDegrees);
  for (double& value : column(run, "gyro_z_radps")) value = std::nan("");
  CHECK_THAT(found(run), Catch::Contains("yaw_rad: looks like degrees: the robot turns"));
}

TEST_CASE("Yaw in degrees is seen in a pose so slow that it turns by more than pi of them between two") {
  // it turns by 0.41 rad/s, 23.6 degrees: in a tenth of a second by 2.4 of them, in a fifth by 4.7
  for (const std::size_t every : {10, 20}) {
    runs::Run run = scaled(arc(), {"yaw_rad"}, kDegrees);
    for (const auto& names : {kPlace, kAngles})
      for (const std::string& name : names)
        for (std::size_t i = 0; i < run.row_count(); ++i)
          if (i % every != 0) column(run, name)[i] = std::nan("");
    INFO(every);
    CHECK_THAT(found(run), Catch::Contains("yaw_rad: looks like degrees") && !Catch::Contains("markers"));
    for (double& value : column(run, "gyro_z_radps")) value = std::nan("");
    CHECK_THAT(found(run), Catch::Contains("yaw_rad: looks like degrees") && !Catch::Contains("markers"));
  }
}

TEST_CASE("Milliamperes of a small robot are seen by what its description allows") {
  // Kenaf's motors take a few amperes: in milliamperes not even a thousand
  runs::Run run = arc();
  for (std::size_t i = 0; i < run.row_count(); ++i) column(run, "track_left_a")[i] = 600 + double(i % 7);
  CHECK_THAT(found(run), Catch::Contains("track_left_a: is 606 A, although the robot's description allows") &&
                             Catch::Contains("milliamperes"));
  CHECK(words(gap::logs::check_run(run, "run.csv", nullptr)) == "");
}

TEST_CASE("A run that no simulation can repeat is refused") {
  const auto level = [](double) { return 0.0; };
  const auto track = [](double t_s) { return t_s < 0.5 ? 0 : 0.2; };
  const auto way = [](double t_s) { return t_s < 0.5 ? 0 : 0.2 * (t_s - 0.5); };
  const std::vector<test::ColumnOfTime> seen{
      {"cmd_track_left_mps", track}, {"cmd_track_right_mps", track}, {"x_m", way}, {"y_m", level}};
  CHECK_THAT(found(test::made_run(4, 0.01, seen)), Catch::StartsWith("run.csv: has no yaw_rad, and its tracks"));
  runs::Run measured{{"t_s", "cmd_track_left_mps", "cmd_track_right_mps", "track_left_mps", "track_right_mps"}, {}};
  measured.values.resize(measured.columns.size());
  for (int i = 0; i <= 36010; ++i) {
    measured.values[0].push_back(0.1 * i);
    for (std::size_t c = 1; c < measured.values.size(); ++c)
      measured.values[c].push_back(0.2 * std::sin(0.01 * i + double(c)));
  }
  CHECK_THAT(found(measured), Catch::Contains("run.csv: lasts 3601 s, more than the 3600 s"));
}

TEST_CASE("Signs that are turned are refused, and sides that are exchanged") {
  CHECK_THAT(found(scaled(arc(), {"gyro_z_radps"}, -1)),
             Catch::Contains("yaw_rad: has the opposite sign of gyro_z_radps"));
  CHECK_THAT(found(scaled(step(), {"pitch_rad"}, -1)),
             Catch::Contains("pitch_rad: has the opposite sign of gyro_y_radps"));
  CHECK_THAT(found(scaled(arc(), {"track_left_mps"}, -1)), Catch::Contains("track_left_mps: has the opposite sign"));
  CHECK_THAT(found(scaled(arc(), {"yaw_rad", "gyro_z_radps"}, -1)),
             Catch::Contains("yaw_rad: has the opposite sign of the tracks"));
  CHECK_THAT(found(scaled(arc(), {"x_m", "y_m"}, -1)), Catch::Contains("x_m: has the opposite sign of the tracks"));
  CHECK_THAT(found(scaled(step(), {"flipper_fl_rad"}, -1)), Catch::Contains("flipper_fl_rad: has the opposite sign"));
  runs::Run exchanged = driven("random-speeds");
  std::swap(column(exchanged, "track_left_mps"), column(exchanged, "track_right_mps"));
  CHECK_THAT(found(exchanged), Catch::Contains("left and right are exchanged"));
}

TEST_CASE("A track that is asked for less than a fifth of the other is no turned sign where that one drags it back") {
  // 3.5 s of each: the left track follows its commands, the right one goes back at 0.1 m/s whatever its command
  const auto dragged = [](double left_mps, double right_mps) {
    const auto steady = [](double speed_mps) { return [=](double t_s) { return t_s < 0.5 ? 0 : speed_mps; }; };
    return found(test::made_run(4, 0.01,
                                {{"cmd_track_left_mps", steady(left_mps)},
                                 {"cmd_track_right_mps", steady(right_mps)},
                                 {"track_left_mps", steady(left_mps)},
                                 {"track_right_mps", steady(-0.1)}}));
  };
  const auto is_refused = Catch::Contains("track_right_mps: has the opposite sign of cmd_track_right_mps");
  CHECK_THAT(dragged(0.5, 0.05), !is_refused);
  CHECK_THAT(dragged(0.5, 0.09), !is_refused);
  CHECK_THAT(dragged(-0.5, 0.09), !is_refused);
  CHECK_THAT(dragged(0.5, 0.12), is_refused);
  CHECK_THAT(dragged(-0.5, 0.12), is_refused);
  // with a track that is commanded as little it is
  CHECK_THAT(dragged(0.09, 0.09), is_refused);
}

TEST_CASE("A track that is asked for next to nothing and dragged along is not in centimetres, both tracks may be") {
  // as a skid-steered robot that is commanded to turn about its right track, and began in motion
  const auto findings = [](double left_mps, double right_mps, double measured_right_mps) {
    const auto steady = [](double speed_mps) { return [=](double t_s) { return t_s < 0.5 ? 0 : speed_mps; }; };
    return found(test::made_run(4, 0.01,
                                {{"cmd_track_left_mps", steady(left_mps)},
                                 {"cmd_track_right_mps", steady(right_mps)},
                                 {"track_left_mps", steady(0.4)},
                                 {"track_right_mps", steady(measured_right_mps)}}));
  };
  CHECK_THAT(findings(0.4, 0.002, 0.2), !Catch::Contains("refused") && !Catch::Contains("looks like"));
  CHECK_THAT(findings(0.4, 0.004, 0.4), !Catch::Contains("looks like"));
  CHECK_THAT(findings(0.004, 0.004, 0.4), Catch::Contains("track_left_mps: looks like centimetres"));
}

TEST_CASE("A robot that slides down a ramp against its tracks is warned of, whatever its speed") {
  for (const double speed_mps : {-0.1, -0.2, -0.5}) {
    const auto findings = gap::logs::check_run(carried(speed_mps, -0.5), "run.csv", &nominal());
    INFO(words(findings));
    CHECK_FALSE(gap::logs::any_refused(findings));
    CHECK_THAT(words(findings), Catch::StartsWith("warning: run.csv: x_m: is opposite to the tracks"));
  }
  // on level ground nothing but a turned sign does that, where it goes as far as the tracks
  CHECK_THAT(found(carried(-0.2, 0)), Catch::StartsWith("run.csv: x_m: has the opposite sign of the tracks"));
  CHECK_THAT(found(carried(-0.5, 0)), Catch::StartsWith("warning: run.csv: x_m: is opposite to the tracks"));
  CHECK(found(carried(0.2, -0.5)) == "");
}

TEST_CASE("A heading that never changes is refused where something else saw a turn") {
  const auto with = [](const std::string& name, double value) {
    runs::Run run = changed(carried(0.2, 0), {"yaw_rad"}, [](double) { return 0.0; });
    if (name == "gyro_z_radps") {
      run.columns.push_back(name);
      run.values.emplace_back(run.row_count());
      for (std::size_t i = 0; i < run.row_count(); ++i) run.values.back()[i] = value + (i % 2 == 0 ? 0.001 : 0);
    } else if (!name.empty()) {
      for (double& speed : column(run, name)) speed = value;
    }
    return found(run);
  };
  const std::string straight = with("", 0);  // in whole degrees
  CHECK_THAT(straight, Catch::StartsWith("warning: run.csv: yaw_rad: never changes while the robot drives"));
  CHECK(with("gyro_z_radps", 0.02) == straight);  // a bias of a degree a second
  CHECK_THAT(with("gyro_z_radps", 0.3), Catch::Contains("run.csv: yaw_rad: never changes while the robot turns") &&
                                            !Catch::Contains("warning: run.csv: yaw_rad"));
  // 0.1 m/s apart for 4 s are 2 rad at the robot's gauge of 0.2 m
  CHECK_THAT(with("track_left_mps", 0.1), Catch::Contains("run.csv: yaw_rad: never changes while the robot turns"));
}

TEST_CASE(
    "Time in milliseconds is detected by the travel that adds up, gaps, odd steps and other clocks are warned of") {
  CHECK_THAT(found(scaled(arc(), {"t_s"}, 1000)),
             Catch::Contains("run.csv: t_s: looks like milliseconds: it steps by 10"));
  CHECK_THAT(found(scaled(arc(), {"t_s"}, 1e6)), Catch::Contains("t_s: looks like microseconds"));
  CHECK_THAT(found(changed(arc(), {"t_s"}, [](double t) { return t + 1.7e9; })),
             Catch::Contains("t_s: begins at 1700000000"));
  // Row 301 of the file, with the header, is the first after 3 s; its time and all later ones are two seconds later.
  const std::string gap = found(changed(arc(), {"t_s"}, [](double t) { return t > 2.985 ? t + 2 : t; }));
  CHECK_THAT(gap, Catch::StartsWith("warning: run.csv:301: t_s: has 1 gaps of up to 2.01 s"));
  // A clock that was set during the run: said, and no reason to walk through the years between.
  CHECK_THAT(found(changed(arc(), {"t_s"}, [](double t) { return t > 6 ? t + 1.7e9 : t; })), Catch::Contains("1 gaps"));
  // Written in bursts: four rows 1 ms apart, then 37 ms nothing.
  runs::Run bursts = arc();
  for (std::size_t i = 0; i < bursts.row_count(); ++i) {
    const std::size_t burst = i / 4, row = i % 4;
    column(bursts, "t_s")[i] = 0.04 * static_cast<double>(burst) + 0.001 * static_cast<double>(row);
  }
  CHECK_THAT(found(bursts), Catch::Contains("use the times of measurement, not of writing"));
}

TEST_CASE("Dead encoders, frozen poses and commands that were not recorded") {
  const auto frozen = [](const std::vector<std::string>& names) {
    return found(changed(arc(), names, [](double) { return 0.5; }));
  };
  CHECK_THAT(frozen({"track_left_mps"}), Catch::Contains("run.csv: track_left_mps: never changes, although") &&
                                             Catch::Contains("the encoder is dead"));
  CHECK_THAT(frozen({"x_m", "y_m", "z_m", "yaw_rad"}), Catch::Contains("run.csv: x_m: never changes, nor does y_m"));
  CHECK_THAT(frozen({"yaw_rad"}), Catch::Contains("the heading is not measured"));
  CHECK_THAT(frozen({"gyro_z_radps"}), Catch::Contains("warning: run.csv: gyro_z_radps: never changes"));
  CHECK_THAT(found(scaled(arc(), kCommands, 0)), Catch::Contains("the commands were not recorded"));
  CHECK_THAT(found(changed(arc(), kCommands, [](double) { return std::nan(""); })),
             Catch::Contains("is missing or empty"));
  CHECK_THAT(found(changed(arc(), kPlace, [](double) { return std::nan(""); })), Catch::Contains("kenaf-gap merge"));

  // The pose of 4 s is repeated until 6 s.
  runs::Run repeated = arc();
  for (const std::string& name : kPlace)
    for (std::size_t i = 401; i < 600; ++i) column(repeated, name)[i] = column(repeated, name)[400];
  CHECK_THAT(found(repeated), Catch::StartsWith("warning: run.csv:402: x_m: is constant to the last digit for 1.99 s"));
}

TEST_CASE("Held values are reported with their duration, the whole counts of a live sensor are not") {
  const auto held = [](runs::Run run, const std::string& name, std::size_t rows) {
    std::vector<double>& values = column(run, name);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = values[i - i % rows];
    return run;
  };
  // rows come each 10 ms
  CHECK_THAT(found(held(arc(), "track_left_mps", 25)),
             Catch::StartsWith("warning: run.csv: track_left_mps: repeats each value for 0.25 s"));
  CHECK_THAT(found(held(arc(), "yaw_rad", 2)),
             Catch::StartsWith("warning: run.csv: yaw_rad: repeats each value for 0.02 s"));
  // commands do hold
  CHECK(found(held(arc(), "cmd_track_left_mps", 25)).empty());
  // an encoder of 5 mm/s a count, a heading in degrees
  const auto in_counts = [](const std::string& name, double count) {
    return found(changed(arc(), {name}, [=](double value) { return count * std::round(value / count); }));
  };
  CHECK(in_counts("track_left_mps", 0.005).empty());
  CHECK(in_counts("yaw_rad", 1 / kDegrees).empty());

  // once for all runs
  runs::Dataset dataset;
  dataset.runs = {{"a.csv", "arc", ""}, {"b.csv", "arc", ""}, {"c.csv", "arc", ""}};
  const runs::Run slow = held(arc(), "gyro_z_radps", 10);
  const std::string findings =
      words(gap::logs::check_plausibility(dataset, std::vector{slow, arc(), slow}, &nominal()));
  CHECK_THAT(findings, Catch::StartsWith("warning: a.csv: gyro_z_radps: repeats each value for 0.1 s") &&
                           Catch::EndsWith("(as in 1 more)\n"));
  CHECK(std::ranges::count(findings, '\n') == 1);
}

TEST_CASE("A pose that jumps is warned of with its line, one that begins late too") {
  runs::Run jumps = arc();
  column(jumps, "x_m")[500] += 0.8;
  CHECK_THAT(found(jumps),
             Catch::StartsWith("warning: run.csv:502: x_m: jumps 2 times with y_m and z_m, by up to 0.8"));
  runs::Run turns = arc();
  column(turns, "yaw_rad")[500] += 1.5;
  CHECK_THAT(found(turns), Catch::Contains("warning: run.csv:502: yaw_rad: jumps 2 times"));
  runs::Run late = arc();
  for (const std::string& name : kPlace)
    for (std::size_t i = 0; i < 100; ++i) column(late, name)[i] = std::nan("");
  CHECK_THAT(found(late), Catch::StartsWith("warning: run.csv:102: x_m: has no value before 1 s"));
  runs::Run never_both = arc();
  for (std::size_t i = 0; i < never_both.row_count(); ++i)
    column(never_both, i % 2 == 0 ? "x_m" : "y_m")[i] = std::nan("");
  CHECK_THAT(found(never_both), Catch::Contains("x_m: has no value in any row in which y_m has one"));
}

TEST_CASE("A run of a few rows tells nothing, a noise that no column has is warned of") {
  CHECK_THAT(found({{"t_s"}, {{0, 1}}}), Catch::Contains("run.csv: has 2 rows"));
  runs::Dataset dataset;
  dataset.noise = {{"x_m", 0.001}, {"x_mm", 1}};
  dataset.runs = {{"run.csv", "arc", ""}};
  CHECK(words(gap::logs::check_plausibility(dataset, std::vector{arc()}, &nominal())) ==
        "warning: dataset.toml: x_mm: has a [noise], but no run has such a column; is its name right?\n");
}

TEST_CASE("The command check ends with 2 where something is refused, and with 0 else") {
  const test::TemporaryFolder folder;
  REQUIRE(test::kenaf_gap(folder, "simulate --manoeuvre straight-fast --out data").status == 0);
  auto outcome = test::kenaf_gap(folder, "check data");
  CHECK(outcome.status == 0);
  CHECK(outcome.out == "1 runs; findings: 0 refused, 0 warned of\n");
  // a run by itself, too
  outcome = test::kenaf_gap(folder, "check data/run-000.csv --robot kenaf");
  CHECK(outcome.status == 0);
  CHECK(outcome.out == "1 runs; findings: 0 refused, 0 warned of\n");
  outcome = test::kenaf_gap(folder, "check data --robot kenaf");
  CHECK(outcome.status == 2);
  CHECK_THAT(outcome.error, Catch::Contains("data: a dataset names its robot; --robot is for a run file"));
  CHECK(test::kenaf_gap(folder, "check data/missing.csv").status == 2);
  runs::Run run = scaled(runs::read_run(folder / "data/run-000.csv"), kPlace, 1000);
  runs::RunWriter writer(folder / "data/run-000.csv", run.columns);
  for (std::size_t i = 0; i < run.row_count(); ++i) {
    std::vector<double> row;
    for (const auto& values : run.values) row.push_back(values[i]);
    writer.add_row(row);
  }
  writer.finish();
  outcome = test::kenaf_gap(folder, "check data");
  CHECK(outcome.status == 2);
  CHECK_THAT(outcome.out, Catch::StartsWith("run-000.csv: x_m: looks like millimetres"));
  CHECK_THAT(outcome.error, Catch::Contains("data: 1 runs; findings: 1 refused"));
  outcome = test::kenaf_gap(folder, "check data/run-000.csv");
  CHECK(outcome.status == 2);
  CHECK_THAT(outcome.out, Catch::StartsWith("run-000.csv: x_m: looks like millimetres"));
  CHECK_THAT(outcome.error, Catch::Contains("run-000.csv: 1 runs; findings: 1 refused"));
  CHECK(test::kenaf_gap(folder, "check").status == 2);
}
