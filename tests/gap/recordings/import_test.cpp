// kenaf-gap import as a user runs it: guess a mapping, look at it, import.
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "formats/runs/run_file.hpp"
#include "gap/recordings/mapping.hpp"
#include "tests/gap/kenaf_gap.hpp"

using namespace kenaf;
using test::kenaf_gap;
using test::Outcome;
using test::TemporaryFolder;

namespace import_test {
namespace {

const std::string kFixtures = KENAF_SOURCE_DIR "/tests/gap/recordings/fixtures/";

// A drive on a circle to the left: 0.2 m/s, 0.4 rad/s, as PlotJuggler writes it at 50 Hz; tracks 0.2 m apart.
std::string circle() {
  std::string text =
      "__time,/cmd_vel/linear/x,/cmd_vel/angular/z,/tracks/left_speed_mmps,/tracks/right_speed_mmps,/imu/"
      "angular_velocity/z,"
      "/mocap/pose/position/x,/mocap/pose/position/y,/mocap/pose/position/z,/mocap/pose/orientation/x,"
      "/mocap/pose/orientation/y,/mocap/pose/orientation/z,/mocap/pose/orientation/w\n";
  for (int i = 0; i < 500; ++i) {
    const double t = 0.02 * i, moving = std::max(0.0, t - 1), yaw = 0.4 * moving;
    const double v = t > 1 ? 0.2 : 0, w = t > 1 ? 0.4 : 0;
    for (const double value : {1.7e9 + t, v, w, 1000 * (v - 0.1 * w), 1000 * (v + 0.1 * w), w, 0.5 * std::sin(yaw),
                               0.5 * (1 - std::cos(yaw)), 0.09, 0.0, 0.0, std::sin(yaw / 2), std::cos(yaw / 2)})
      text += (text.back() == '\n' ? "" : ",") + nlohmann::json(value).dump();
    text += '\n';
  }
  return text;
}

}  // namespace

TEST_CASE("A guessed mapping is one that an import takes, and says what to check and what is not used") {
  const TemporaryFolder folder;
  for (const char* file : {"foreign-zstd.mcap", "foreign-bz2.bag"}) {
    INFO(file);
    const Outcome guess = kenaf_gap(folder, "import " + kFixtures + file + " --guess --robot kenaf");
    REQUIRE(guess.status == 0);
    CHECK_THAT(guess.out, Catch::Contains("v = \"/cmd_vel/"));
    CHECK_THAT(guess.out, Catch::Contains("# CHECK its sign"));
    test::write_file(folder / "m.toml", guess.out);
    const Outcome made = kenaf_gap(
        folder, std::string("import ") + kFixtures + file + " --mapping m.toml --robot kenaf --out run.csv --force");
    INFO(made.error);
    REQUIRE(made.status == 0);
    CHECK_THAT(made.out, Catch::Contains("/cmd_vel"));
    const runs::Run run = runs::read_run(folder / "run.csv");
    CHECK(run.row_count() == 20);
    CHECK(runs::any_measured(run.column("cmd_track_left_mps")));
  }
  // The transform to base_link starts at odom, so it is no measurement of the body.
  CHECK_THAT(kenaf_gap(folder, "import " + kFixtures + "foreign-zstd.mcap --guess").out,
             Catch::Contains("no measurement of the body") && !Catch::Contains("[pose]"));
}

TEST_CASE("A CSV file of PlotJuggler becomes a run that the checks accept") {
  const TemporaryFolder folder;
  test::write_file(folder / "drive.csv", circle());
  const Outcome guess = kenaf_gap(folder, "import drive.csv --guess --robot kenaf --out maps/");
  INFO(guess.error);
  REQUIRE(guess.status == 0);
  CHECK_THAT(guess.out, Catch::Contains("maps/drive.mapping.toml"));
  const std::string mapping = test::read_file(folder / "maps/drive.mapping.toml");
  CHECK_THAT(mapping, Catch::Contains("unit = \"mm/s\""));
  const Outcome made =
      kenaf_gap(folder, "import drive.csv --mapping maps/drive.mapping.toml --robot kenaf --out runs/");
  INFO(made.error + made.out);
  REQUIRE(made.status == 0);
  CHECK_THAT(made.out, !Catch::Contains("to be refused") && !Catch::Contains("warning"));

  const runs::Run run = runs::read_run(folder / "runs/drive.csv");
  REQUIRE(run.row_count() == 500);
  // At 6 s it has turned by 0.4 * 5 = 2 rad on the circle of 0.5 m.
  CHECK(run.column("t_s")[300] == Approx(6).margin(1e-6));
  CHECK(run.column("track_left_mps")[300] == Approx(0.16));
  CHECK(run.column("track_right_mps")[300] == Approx(0.24));
  CHECK(run.column("cmd_track_right_mps")[300] == Approx(0.2 + 0.1 * 0.4));
  CHECK(run.column("yaw_rad")[300] == Approx(2).margin(1e-6));
  CHECK(run.column("x_m")[300] == Approx(0.5 * std::sin(2)).margin(1e-6));

  const Outcome dataset = kenaf_gap(folder, "dataset runs/drive.csv --manoeuvre circle --world flat --out real");
  INFO(dataset.error);
  CHECK(dataset.status == 0);
  CHECK(kenaf_gap(folder, "check real").status == 0);

  const Outcome part =
      kenaf_gap(folder, "import drive.csv --mapping maps/drive.mapping.toml --from 2 --to 3.99 --out part.csv");
  REQUIRE(part.status == 0);
  CHECK(runs::read_run(folder / "part.csv").row_count() == 100);
}

TEST_CASE("An export of Motive becomes a run of the pose alone") {
  const TemporaryFolder folder;
  std::string text =
      "Format Version,1.23,Rotation Type,Quaternion,Length Units,Meters\n\n,,Rigid Body,Rigid Body,Rigid Body,Rigid "
      "Body,"
      "Rigid Body,Rigid Body,Rigid Body\n,,Robot,Robot,Robot,Robot,Robot,Robot,Robot\n,,1,1,1,1,1,1,1\n"
      ",,Rotation,Rotation,Rotation,Rotation,Position,Position,Position\nFrame,Time (Seconds),X,Y,Z,W,X,Y,Z\n";
  // forward along x, to the left along -z, at a height of 0.09
  for (int i = 0; i < 20; ++i)
    text += std::to_string(i) + "," + std::to_string(0.01 * i) + ",0,0,0,1," + std::to_string(0.02 * i) + ",0.09," +
            std::to_string(-0.01 * i) + "\n";
  test::write_file(folder / "take.csv", text);
  REQUIRE(kenaf_gap(folder, "import take.csv --guess --out m.toml").status == 0);
  CHECK_THAT(test::read_file(folder / "m.toml"), Catch::Contains("up = \"y\""));
  const Outcome made = kenaf_gap(folder, "import take.csv --mapping m.toml --out pose.csv");
  INFO(made.error);
  REQUIRE(made.status == 0);
  const runs::Run run = runs::read_run(folder / "pose.csv");
  CHECK(run.column("x_m")[10] == Approx(0.2));
  CHECK(run.column("y_m")[10] == Approx(0.1));
  CHECK(run.column("z_m")[10] == Approx(0.09));
}

TEST_CASE("A capture whose y axis points up is refused until the mapping says so, and is merged then") {
  const TemporaryFolder folder;
  // Winding, mostly to the capture's left, which is -z, as y points up. The robot's log is 2 s behind.
  std::string capture = "t_s,x_mm,y_mm,z_mm,qx,qy,qz,qw\n", log = "t_s,track_left_mps,track_right_mps,gyro_z_radps\n";
  const auto turn_radps = [](double t) {
    return t > 1 && t < 9 ? 0.4 * std::sin(1.3 * t) + 0.3 * std::sin(2.9 * t) : 0;
  };
  double yaw = 1.4, x = 0, y = 0;
  for (int i = 0; i < 1000; ++i) {
    const double t = 0.01 * i, w = turn_radps(t), v = t > 1 && t < 9 ? 0.2 : 0;
    for (const double value : {t + 2, 1000 * x, 90.0, -1000 * y, 0.0, std::sin(yaw / 2), 0.0, std::cos(yaw / 2)})
      capture += (capture.back() == '\n' ? "" : ",") + nlohmann::json(value).dump();
    for (const double value : {t, v - 0.1 * w, v + 0.1 * w, w})
      log += (log.back() == '\n' ? "" : ",") + nlohmann::json(value).dump();
    capture += '\n', log += '\n';
    yaw += 0.01 * w, x += 0.01 * v * std::cos(yaw), y += 0.01 * v * std::sin(yaw);
  }
  test::write_file(folder / "capture.csv", capture);
  test::write_file(folder / "log.csv", log);
  REQUIRE(kenaf_gap(folder, "import capture.csv --guess --out m.toml").status == 0);
  const Outcome refused = kenaf_gap(folder, "import capture.csv --mapping m.toml --out pose.csv");
  CHECK(refused.status == 2);
  CHECK_THAT(refused.error, Catch::Contains("up = \"y\""));
  test::write_file(folder / "m.toml", test::read_file(folder / "m.toml") + "up = \"y\"\n");
  const Outcome made = kenaf_gap(folder, "import capture.csv --mapping m.toml --out pose.csv");
  INFO(made.error);
  REQUIRE(made.status == 0);
  CHECK_THAT(made.out, Catch::Contains("a pose alone"));
  const Outcome merged = kenaf_gap(folder, "merge log.csv pose.csv --out run.csv");
  INFO(merged.error);
  REQUIRE(merged.status == 0);
  // Both clocks begin with their first row.
  CHECK_THAT(merged.out, Catch::Contains("time offset: "));
  const runs::Run run = runs::read_run(folder / "run.csv");
  CHECK(run.column("z_m")[500] == Approx(0.09));
}

TEST_CASE("Wrong uses of import are refused with what to do, and nothing is written") {
  const TemporaryFolder folder;
  const std::string mcap = kFixtures + "foreign-plain.mcap";
  REQUIRE(kenaf_gap(folder, "import " + mcap + " --guess --robot kenaf --out m.toml").status == 0);
  const std::pair<std::string, std::string> cases[] = {
      {"import", "RECORDING"},
      {"import " + mcap, "--guess writes one"},
      {"import " + mcap + " --mapping m.toml", "--out"},
      {"import missing.mcap --guess", "no such file"},
      {"import " + mcap + " --guess --out m.toml", "--force"},
      {"import " + kFixtures + "foreign-none.bag --mapping m.toml --out run.csv", "is for 'MCAP'"},
      {"import " + mcap + " --mapping m.toml --from 5 --to 1 --out run.csv", "--to must be after"},
      {"import " + mcap + " --mapping m.toml --from 100 --out run.csv", "no value of track_left_mps"},
      {"import " + mcap + " --guess --definitions .", "no files PACKAGE/msg/NAME.msg"},
  };
  for (const auto& [arguments, why] : cases) {
    INFO(arguments);
    const Outcome outcome = kenaf_gap(folder, arguments);
    CHECK(outcome.status == 2);
    CHECK_THAT(outcome.error, Catch::Contains(why));
    CHECK_FALSE(std::filesystem::exists(folder / "run.csv"));
  }
}

}  // namespace import_test
