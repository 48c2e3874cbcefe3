// How a recorded run becomes commands to replay, from the place where the robot stood.
#include "gap/diagnose/observation.hpp"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "tests/formats/runs/temporary_folder.hpp"
#include "tests/gap/made_run.hpp"

using namespace kenaf;
using namespace kenaf::gap;
using namespace kenaf::gap::diagnose;

namespace {

// Commanded to stand until `go_s`, then to drive.
runs::Run commanded_to_go(double go_s, std::vector<test::ColumnOfTime> others) {
  const auto command = [go_s](double t_s) { return t_s < go_s ? 0 : 0.2; };
  others.push_back({"cmd_track_left_mps", command});
  others.push_back({"cmd_track_right_mps", command});
  return test::made_run(3, 0.25, others);
}

double zero(double) {
  return 0;
}

}  // namespace

TEST_CASE("A robot that looks backwards starts so: the mean of headings on either side of half a turn") {
  // four rows at rest: 3.140, -3.141, 3.139, -3.140, of which the last three are 0.00219, -0.001 and 0.00319 from the
  // first
  const auto yaw = [](double t_s) {
    const double rest[] = {3.140, -3.141, 3.139, -3.140};
    return t_s < 1 ? rest[std::lround(t_s / 0.25)] : 3.0;
  };
  const Observation seen =
      observation_of({}, commanded_to_go(1, {{"x_m", zero}, {"y_m", zero}, {"yaw_rad", yaw}}), "a.csv");
  REQUIRE(seen.resting_rows == 4);
  CHECK(seen.replay.start->yaw_rad == Approx(3.140 + (0.002185 - 0.001 + 0.003185) / 4).margin(1e-5));
}

TEST_CASE("Where the robot stands is the mean of its first rows, unless it rolls although it was commanded to stand") {
  const auto x = [](double t_s) { return t_s < 0.1 ? 0.0 : 0.004; };
  const auto rolls = [](double t_s) { return 0.3 * std::exp(-4 * t_s); };
  std::vector<test::ColumnOfTime> stands{{"x_m", x}, {"y_m", zero}, {"yaw_rad", zero}};
  CHECK(observation_of({}, commanded_to_go(1, stands), "a.csv").replay.start->x_m == Approx(0.003));
  stands.push_back({"track_left_mps", rolls});
  stands.push_back({"track_right_mps", rolls});
  const Observation rolling = observation_of({}, commanded_to_go(1, stands), "a.csv");
  REQUIRE(rolling.replay.start->motion);
  CHECK(rolling.replay.start->x_m == 0);
}

TEST_CASE("A log whose clock does not begin at 0 is looked at from its own beginning") {
  runs::Run run = commanded_to_go(1, {{"x_m", zero}, {"y_m", zero}, {"yaw_rad", zero}});
  for (double& t_s : run.values[0]) t_s += 100;
  const Observation seen = observation_of({}, run, "a.csv");
  CHECK(seen.run.column("t_s").front() == 0);
  CHECK(seen.run.column("t_s").back() == Approx(2.75));
}

TEST_CASE("A quantity without a sensor in the description is reported, and not compared") {
  const test::TemporaryFolder folder;
  const auto x = [](double t_s) { return t_s < 1 ? 0 : 0.2 * (t_s - 1); };
  const auto turn_rate = [](double t_s) { return t_s < 1 ? 0 : 0.2; };
  runs::write_run(folder / "a.csv",
                  commanded_to_go(1, {{"x_m", x}, {"y_m", zero}, {"yaw_rad", x}, {"gyro_z_radps", turn_rate}}));
  for (const auto& [robot, has_gyro] : {std::pair{"kenaf", true}, {"p2dx", false}}) {
    test::write_file(folder / "dataset.toml", "format = \"kenaf-runs/1\"\nsource = \"real\"\nrobot = \"" +
                                                  std::string(robot) +
                                                  "\"\nworld = \"flat\"\n[noise]\ngyro_y_radps = 0.1\n"
                                                  "[[run]]\nfile = \"a.csv\"\n");
    const Observations seen = observe(folder.path(), "", "", 10);
    const auto says = [&](const std::string& words) {
      return std::ranges::any_of(seen.warnings,
                                 [&](const std::string& w) { return w.find(words) != std::string::npos; });
    };
    CHECK(seen.not_simulated == (has_gyro ? std::vector<std::string>{} : std::vector<std::string>{"gyro_z_radps"}));
    CHECK(says("gyro_z_radps: not compared, because the described robot has no sensor for it") == !has_gyro);
    CHECK(says("gyro_y_radps: has a [noise], but no run has such a column"));
  }
}

TEST_CASE("An implausible run of ten is left out, of nine it ends the diagnosis, and is used unchecked") {
  const test::TemporaryFolder folder;
  const auto x = [](double t_s) { return t_s < 1 ? 0 : 0.2 * (t_s - 1); };
  const auto millimetres = [](double t_s) { return t_s < 1 ? 0 : 200 * (t_s - 1); };
  std::string toml = "format = \"kenaf-runs/1\"\nsource = \"real\"\nrobot = \"kenaf\"\nworld = \"flat\"\n";
  const auto write = [&](int number, double (*way)(double)) {
    const std::string name = std::to_string(number) + ".csv";
    const auto yaw = [number](double t_s) { return 0.0001 * (number + 1) * std::sin(t_s); };
    runs::write_run(folder / name, commanded_to_go(1, {{"x_m", way}, {"y_m", zero}, {"yaw_rad", yaw}}));
    toml += "[[run]]\nfile = \"" + name + "\"\n";
    test::write_file(folder / "dataset.toml", toml);
  };
  write(0, millimetres);
  for (int i = 1; i < 9; ++i) write(i, x);
  CHECK_THROWS_WITH(observe(folder.path(), "", "", 10), Catch::Contains("0.csv: x_m: looks like millimetres"));
  CHECK(observe(folder.path(), "", "", 10, {.unchecked = true}).runs.size() == 9);
  write(9, x);
  const Observations seen = observe(folder.path(), "", "", 10);
  CHECK(seen.runs.size() == 9);
  CHECK(seen.runs.front().file == "1.csv");
  CHECK(std::ranges::any_of(seen.warnings, [](const std::string& words) {
    return words.starts_with("0.csv: x_m: looks like millimetres") && words.ends_with("(the run is left out)");
  }));
  CHECK_THROWS_WITH(observe(folder.path(), "", "", 10, {.strict = true}), Catch::Contains("looks like millimetres"));
}

TEST_CASE("A sensor that is dead in a run counts as not measured in it, and is reported") {
  const test::TemporaryFolder folder;
  const auto x = [](double t_s) { return t_s < 1 ? 0 : 0.2 * (t_s - 1); };
  const auto dead = [](double) { return 0.5; };
  const auto rate = [](double t_s) { return t_s < 1 ? 0.001 : 0.002 * t_s; };
  const auto write = [&](const char* name, double (*gyro)(double), double (*current)(double)) {
    runs::write_run(
        folder / name,
        commanded_to_go(
            1, {{"x_m", x}, {"y_m", zero}, {"yaw_rad", rate}, {"gyro_z_radps", gyro}, {"track_left_a", current}}));
  };
  write("dead.csv", dead, dead);
  write("right.csv", rate, x);
  test::write_file(folder / "dataset.toml",
                   "format = \"kenaf-runs/1\"\nsource = \"real\"\nrobot = \"kenaf\"\nworld = \"flat\"\n"
                   "[[run]]\nfile = \"dead.csv\"\n[[run]]\nfile = \"right.csv\"\n");
  const Observations seen = observe(folder.path(), "", "", 10);
  REQUIRE(seen.runs.size() == 2);
  for (const char* name : {"gyro_z_radps", "track_left_a"}) {
    CHECK_FALSE(runs::any_measured(seen.runs[0].run.column(name)));
    CHECK(runs::any_measured(seen.runs[1].run.column(name)));
  }
  CHECK(runs::any_measured(seen.runs[0].run.column("x_m")));
  REQUIRE(seen.warnings.size() == 2);
  CHECK_THAT(seen.warnings[0],
             Catch::StartsWith("dead.csv: track_left_a: never changes") && Catch::EndsWith("(left out)"));
  CHECK_THAT(seen.warnings[1],
             Catch::StartsWith("dead.csv: gyro_z_radps: never changes") && Catch::EndsWith("(left out)"));
}

TEST_CASE("For a robot that is lifted off the ground only the drives are compared, with a warning") {
  const test::TemporaryFolder folder;
  const auto sways = [](double t_s) { return 0.03 * std::sin(5 * t_s); };
  const auto goes = [](double t_s) { return t_s < 1 ? 0 : 0.3 * (t_s - 1); };
  const auto forward = [](double t_s) { return t_s < 1 ? 0 : 0.3; };
  const auto backward = [](double t_s) { return t_s < 1 ? 0 : -0.3; };
  const auto turns = [](double t_s) { return t_s < 1 ? 0 : 1.2 * (t_s - 1); };  // of 0.6 m/s at a gauge of 0.2 m 40 %
  using Column = double (*)(double);
  // tracks that go 0.6 m in two seconds, and what the body does
  const auto is_lifted = [&](std::vector<std::array<Column, 4>> tracks_x_yaw) {
    std::string dataset = "format = \"kenaf-runs/1\"\nsource = \"real\"\nrobot = \"kenaf\"\nworld = \"flat\"\n";
    for (std::size_t i = 0; i < tracks_x_yaw.size(); ++i) {
      const auto& [left, right, x, yaw] = tracks_x_yaw[i];
      const std::string file = std::string(1, static_cast<char>('a' + i)) + ".csv";
      runs::write_run(folder / file, test::made_run(3.05, 0.05,
                                                    {{"cmd_track_left_mps", left},
                                                     {"cmd_track_right_mps", right},
                                                     {"track_left_mps", left},
                                                     {"track_right_mps", right},
                                                     {"x_m", x},
                                                     {"y_m", zero},
                                                     {"yaw_rad", yaw}}));
      dataset += "[[run]]\nfile = \"" + file + "\"\n";
    }
    test::write_file(folder / "dataset.toml", dataset);
    const Observations seen = observe(folder.path(), "", "", 10);
    const bool is_reported = std::ranges::any_of(seen.warnings, [](const std::string& warning) {
      return warning.starts_with("dataset.toml: x_m: the body moves less than 0.065 m in all 3 runs") &&
             warning.ends_with("(the drives alone are compared)");
    });
    for (const Observation& run : seen.runs) {
      CHECK(runs::any_measured(run.run.column("x_m")) != is_reported);
      CHECK(runs::any_measured(run.run.column("yaw_rad")) != is_reported);
      CHECK(runs::any_measured(run.run.column("track_left_mps")));
    }

    return is_reported;
  };
  const std::array<Column, 4> in_the_air{forward, forward, sways, zero},
      back_in_the_air{backward, backward, sways, zero}, on_the_spot_in_the_air{backward, forward, sways, sways},
      on_the_ground{forward, forward, goes, zero}, turning{backward, forward, sways, turns},
      standing{zero, zero, sways, zero};
  CHECK(is_lifted({in_the_air, on_the_spot_in_the_air, back_in_the_air}));
  CHECK(is_lifted({in_the_air, on_the_spot_in_the_air, back_in_the_air, standing}));
  CHECK_FALSE(is_lifted({in_the_air, on_the_spot_in_the_air, back_in_the_air, on_the_ground}));
  CHECK_FALSE(is_lifted({in_the_air, on_the_spot_in_the_air, back_in_the_air, turning}));
  CHECK_FALSE(is_lifted({in_the_air, back_in_the_air}));  // one that is stuck does that, too
}

TEST_CASE("Cells that only repeat a value count as not measured, and are reported") {
  const test::TemporaryFolder folder;
  const auto command = [](double t_s) { return t_s < 1 ? 0 : 0.2; };
  const auto x = [](double t_s) { return t_s < 1 ? 0 : 0.2 * (t_s - 1); };
  const auto yaw = [](double t_s) { return 0.05 * t_s * t_s * t_s / 3; };
  // its rate, 0.05 t^2, as a new value each 0.2 s, where rows come each 10 ms
  const auto held = [](double t_s) { return 0.002 * std::pow(std::floor(t_s / 0.2 + 1e-6), 2); };
  runs::write_run(folder / "held.csv", test::made_run(4, 0.01,
                                                      {{"cmd_track_left_mps", command},
                                                       {"cmd_track_right_mps", command},
                                                       {"x_m", x},
                                                       {"y_m", zero},
                                                       {"yaw_rad", yaw},
                                                       {"gyro_z_radps", held}}));
  test::write_file(folder / "dataset.toml",
                   "format = \"kenaf-runs/1\"\nsource = \"real\"\nrobot = \"kenaf\"\nworld = \"flat\"\n"
                   "[[run]]\nfile = \"held.csv\"\n");
  const Observations seen = observe(folder.path(), "", "", 10);
  REQUIRE(seen.runs.size() == 1);
  const runs::Run& run = seen.runs[0].run;
  const auto time = run.column("t_s"), gyro = run.column("gyro_z_radps");
  for (std::size_t i = 0; i < gyro.size(); ++i) {
    const bool is_new = std::abs(std::remainder(time[i], 0.2)) < 1e-6;
    CAPTURE(time[i], gyro[i]);
    CHECK(std::isnan(gyro[i]) != is_new);
  }
  REQUIRE(seen.warnings.size() == 1);
  CHECK_THAT(seen.warnings[0], Catch::StartsWith("held.csv: gyro_z_radps: repeats each value for 0.2 s") &&
                                   Catch::EndsWith("(repeats left out)"));
}

TEST_CASE("A run that was copied is no repeat: it is left out, and reported once") {
  const test::TemporaryFolder folder;
  const auto x = [](double t_s) { return t_s < 1 ? 0 : 0.2 * (t_s - 1); };
  const auto other = [](double t_s) { return t_s < 1 ? 0.001 : 0.2 * (t_s - 1); };
  const runs::Run run = commanded_to_go(1, {{"x_m", x}, {"y_m", zero}, {"yaw_rad", x}});
  std::string dataset = "format = \"kenaf-runs/1\"\nsource = \"real\"\nrobot = \"kenaf\"\nworld = \"flat\"\n";
  for (const std::string name : {"a", "b", "c", "d"}) {
    // one value of c is another one, in its first row
    runs::write_run(folder / (name + ".csv"),
                    name == "c" ? commanded_to_go(1, {{"x_m", other}, {"y_m", zero}, {"yaw_rad", x}}) : run);
    dataset += "[[run]]\nfile = \"" + name + ".csv\"\nmanoeuvre = \"straight\"\n";
  }
  test::write_file(folder / "dataset.toml", dataset);
  const Observations seen = observe(folder.path(), "", "", 10);
  REQUIRE(seen.runs.size() == 2);
  CHECK(seen.runs[0].file == "a.csv");
  CHECK(seen.runs[1].file == "c.csv");
  REQUIRE(seen.warnings.size() == 1);
  CHECK(seen.warnings[0] == "b.csv: contains the same numbers as a.csv; a copy is not a repeat (left out, as 1 more)");
}

TEST_CASE("Of more manoeuvres than places, runs are taken from some of all, not from the last ones") {
  const test::TemporaryFolder folder;
  std::string dataset = "format = \"kenaf-runs/1\"\nsource = \"real\"\nrobot = \"kenaf\"\nworld = \"flat\"\n";
  const auto x = [](double t_s) { return t_s < 1 ? 0 : 0.2 * (t_s - 1); };
  runs::Run run = commanded_to_go(1, {{"x_m", x}, {"y_m", zero}, {"yaw_rad", x}});
  for (const char* name : {"a", "b", "c", "d", "e", "f"}) {
    for (double& x_m : run.values[1]) x_m += 0.001;  // copies of one run would be left out
    runs::write_run(folder / (std::string(name) + ".csv"), run);
    dataset += "\n[[run]]\nfile = \"" + std::string(name) + ".csv\"\nmanoeuvre = \"" + name + "\"\n";
  }
  test::write_file(folder / "dataset.toml", dataset);
  const Observations drawn = observe(folder.path(), {}, {}, 3);
  REQUIRE(drawn.runs.size() == 3);
  CHECK(drawn.runs[0].manoeuvre == "a");
  CHECK(drawn.runs[1].manoeuvre == "c");
  CHECK(drawn.runs[2].manoeuvre == "e");
}

TEST_CASE("A run without a heading is compared by its drives, one that cannot be repeated is left out") {
  const test::TemporaryFolder folder;
  const auto track = [](double t_s) { return t_s < 1 ? 0 : 0.2; };
  const auto x = [](double t_s) { return t_s < 1 ? 0 : 0.2 * (t_s - 1); };
  std::string toml = "format = \"kenaf-runs/1\"\nsource = \"real\"\nrobot = \"kenaf\"\nworld = \"flat\"\n";
  const auto write = [&](const std::string& name, std::vector<test::ColumnOfTime> columns, bool tracks) {
    if (tracks) columns.insert(columns.end(), {{"track_left_mps", track}, {"track_right_mps", track}});
    // the gyro's noise tells the runs apart
    columns.push_back({"gyro_z_radps", [name](double t_s) { return 1e-4 * std::sin(t_s + name[0]); }});
    runs::write_run(folder / (name + ".csv"), commanded_to_go(1, columns));
    toml += "[[run]]\nfile = \"" + name + ".csv\"\n";
  };
  write("a", {{"x_m", x}, {"y_m", zero}}, false);  // no heading to start with, and nothing else to compare
  write("b", {{"x_m", x}, {"y_m", zero}}, true);
  for (const char* name : {"c", "d", "e", "f", "g", "h", "i", "j", "k"}) write(name, {}, true);
  test::write_file(folder / "dataset.toml", toml);
  for (const bool unchecked : {false, true}) {
    const Observations seen = observe(folder.path(), "", "", 20, {.unchecked = unchecked});
    REQUIRE(seen.runs.size() == 10);
    CHECK(seen.runs[0].file == "b.csv");
    CHECK_FALSE(runs::any_measured(seen.runs[0].run.column("x_m")));
    CHECK(runs::any_measured(seen.runs[0].run.column("track_left_mps")));
    CHECK(runs::any_measured(seen.runs[0].run.column("gyro_z_radps")));
    CHECK(seen.runs[1].replay.start->x_m == 0);
    CHECK(seen.runs[1].measured);
    const auto says = [&](const std::string& begin, const std::string& words) {
      return std::ranges::any_of(seen.warnings, [&](const std::string& warning) {
        return warning.find(begin) != std::string::npos && warning.find(words) != std::string::npos;
      });
    };
    CHECK(says("a.csv: has no yaw_rad", "(the run is left out)"));
    CHECK(says("b.csv: yaw_rad: is missing", "x_m and y_m are not compared"));
  }
}

TEST_CASE("A run that cannot be read is left out of many") {
  const test::TemporaryFolder folder;
  const auto x = [](double t_s) { return t_s < 1 ? 0 : 0.2 * (t_s - 1); };
  std::string toml =
      "format = \"kenaf-runs/1\"\nsource = \"real\"\nrobot = \"kenaf\"\nworld = \"flat\"\n"
      "[[run]]\nfile = \"twice.csv\"\n";
  test::write_file(folder / "twice.csv", "t_s,x_m\n0,0\n0,0\n");
  for (int i = 0; i < 9; ++i) {
    const auto yaw = [i](double t_s) { return 0.0001 * (i + 1) * std::sin(t_s); };
    runs::write_run(folder / (std::to_string(i) + ".csv"),
                    commanded_to_go(1, {{"x_m", x}, {"y_m", zero}, {"yaw_rad", yaw}}));
    toml += "[[run]]\nfile = \"" + std::to_string(i) + ".csv\"\n";
  }
  test::write_file(folder / "dataset.toml", toml);
  const Observations seen = observe(folder.path(), "", "", 20);
  CHECK(seen.runs.size() == 9);
  CHECK(std::ranges::any_of(seen.warnings, [](const std::string& warning) {
    return warning.starts_with("twice.csv: cannot be read: ") && warning.ends_with("(the run is left out)");
  }));
  CHECK_THROWS_WITH(observe(folder.path(), "", "", 20, {.strict = true}), Catch::Contains("t_s does not increase"));
}

TEST_CASE("A robot whose pose hardly moves is on the ground where its gyro turns") {
  // Belts at 0.3 m/s against each other for two seconds, a pose without a heading, a gyro at 2 rad/s: 4 rad at half the
  // gauge of 0.2 m are 0.4 m of the belts' 0.6 m.
  const test::TemporaryFolder folder;
  const auto sways = [](double t_s) { return 0.03 * std::sin(5 * t_s); };
  const auto turned = [&](double rate_radps) {
    std::string dataset = "format = \"kenaf-runs/1\"\nsource = \"real\"\nrobot = \"kenaf\"\nworld = \"flat\"\n";
    for (int i = 0; i < 3; ++i) {
      const double speed_mps = 0.3 + 0.01 * i;
      const auto left = [=](double t_s) { return t_s < 1 ? 0 : -speed_mps; };
      const auto right = [=](double t_s) { return t_s < 1 ? 0 : speed_mps; };
      const auto gyro = [=](double t_s) { return 0.02 + (t_s < 1 ? 0 : rate_radps) + 1e-5 * std::sin(7 * t_s); };
      runs::write_run(folder / (std::to_string(i) + ".csv"), test::made_run(3.05, 0.05,
                                                                            {{"cmd_track_left_mps", left},
                                                                             {"cmd_track_right_mps", right},
                                                                             {"track_left_mps", left},
                                                                             {"track_right_mps", right},
                                                                             {"x_m", sways},
                                                                             {"y_m", zero},
                                                                             {"gyro_z_radps", gyro}}));
      dataset += "[[run]]\nfile = \"" + std::to_string(i) + ".csv\"\n";
    }
    test::write_file(folder / "dataset.toml", dataset);
    const Observations seen = observe(folder.path(), "", "", 10, {.unchecked = true});
    return runs::any_measured(seen.runs.front().run.column("gyro_z_radps"));
  };
  CHECK(turned(2));
  CHECK_FALSE(turned(0));  // its bias of 0.02 rad/s is no turn
}
