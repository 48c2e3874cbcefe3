// kenaf-gap compare as a user runs it: the files that it writes, the numbers in them, and how it refuses.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "formats/runs/dataset.hpp"
#include "formats/runs/run_file.hpp"
#include "tests/gap/kenaf_gap.hpp"

using namespace kenaf;
using nlohmann::json;
using test::kenaf_gap;
using test::Outcome;
using test::read_file;
using test::TemporaryFolder;
using test::write_file;
namespace fs = std::filesystem;

namespace {

struct TestRun {
  std::string manoeuvre;
  double delay_s = 0, lift_m = 0, ahead_m = 0;
  std::string columns = "t_s,x_m,y_m,z_m,roll_rad,pitch_rad,yaw_rad";
  double sideways = 0;  // of the way ahead
};

// 4 s at 20 Hz; after 1 s and the delay it drives 0.4 m at 0.2 m/s, its pitch a tenth of its place.
std::string csv(const TestRun& run) {
  std::string text = run.columns + "\n";
  for (int i = 0; i <= 80; ++i) {
    const double t = 0.05 * i, s = std::min(0.4, std::max(0.0, 0.2 * (t - 1 - run.delay_s)));
    text += std::to_string(t) + "," + std::to_string(run.ahead_m + s) + "," + std::to_string(run.sideways * s) + "," +
            std::to_string(0.1 + run.lift_m) + ",0," + std::to_string(0.1 * s) + ",0\n";
  }
  return text;
}

void make_dataset(const fs::path& folder, const std::vector<TestRun>& test_runs,
                  const std::string& world = "step-200") {
  runs::Dataset dataset{"real", "kenaf", world, "", {}, {}};
  fs::create_directories(folder);
  for (std::size_t i = 0; i < test_runs.size(); ++i) {
    dataset.runs.push_back({"run-" + std::to_string(i) + ".csv", test_runs[i].manoeuvre, ""});
    write_file(folder / dataset.runs.back().file, csv(test_runs[i]));
  }
  runs::write_dataset(folder, dataset);
}

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t found = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++found;
  return found;
}

}  // namespace

TEST_CASE("Two manoeuvres: numbers, files, and what is left out") {
  const TemporaryFolder folder;
  make_dataset(folder / "real", {{"step"}, {"step"}, {"drive"}});
  // the first 0.2 s late, the second 10 mm too high, of the third one too many
  make_dataset(folder / "sim", {{"step", 0.2}, {"step", 0, 0.01}, {"drive"}, {"drive"}});
  const Outcome outcome = kenaf_gap(folder, "compare real sim --out out/report");
  REQUIRE(outcome.status == 0);
  CHECK(outcome.error.empty());
  CHECK_THAT(outcome.out,
             Catch::Contains("step #2") && Catch::Contains("all 3 runs") && Catch::Contains("left out: sim run-3.csv"));

  const json report = json::parse(read_file(folder / "out/report/compare.json"));
  CHECK(report["format"] == "kenaf-gap-compare/1");
  REQUIRE(report["runs"].size() == 3);
  const json &late = report["runs"][0], &high = report["runs"][1];
  // Matching hides the delay: the path is the same. At the same time it is 40 mm behind, 4 mrad of pitch.
  CHECK(late["matched"]["position_m"]["max"].get<double>() == Approx(0).margin(1e-9));
  CHECK(late["matched"]["time_difference_s"]["max"].get<double>() >= 0.2 - 1e-9);
  CHECK(late["same_time"]["position_m"]["max"].get<double>() == Approx(0.04));
  CHECK(late["same_time"]["pitch_rad"]["max"].get<double>() == Approx(0.004));
  CHECK(high["matched"]["position_m"]["mean"].get<double>() == Approx(0.01));
  CHECK(high["at_end"]["position_m"].get<double>() == Approx(0.01));
  CHECK(high["repeat"] == 1);
  REQUIRE(report["manoeuvres"].size() == 2);
  CHECK(report["manoeuvres"][0]["runs"] == json({0, 1}));
  CHECK(report["manoeuvres"][0]["matched"]["position_m"]["mean"].get<double>() == Approx(0.005));
  CHECK(report["all"]["matched"]["frames"] == 3 * 81);
  REQUIRE(report["left_out"].size() == 1);
  CHECK(report["left_out"][0]["dataset"] == "sim");

  const std::string matched = read_file(folder / "out/report/matched-000.csv");
  CHECK(matched.starts_with("real_frame,sim_frame,weight,real_t_s,"));
  CHECK(count(matched, "\n") == 1 + late["pairs"].get<std::size_t>());
  CHECK(fs::exists(folder / "out/report/matched-002.csv"));
  CHECK_FALSE(fs::exists(folder / "out/report/matched-003.csv"));
  for (const auto& entry : fs::directory_iterator(folder / "out/report")) CHECK(entry.path().extension() != ".part");
}

TEST_CASE("The page needs nothing beside itself: four figures a run, the ground behind, no scripts, no links out") {
  const TemporaryFolder folder;
  make_dataset(folder / "real", {{"<script>alert(1)</script>"}, {"drive"}});
  make_dataset(folder / "sim", {{"<script>alert(1)</script>"}, {"drive"}});
  REQUIRE(kenaf_gap(folder, "compare real sim --out out").status == 0);
  const std::string page = read_file(folder / "out/compare.html");
  CHECK(count(page, "<svg class=\"chart\"") == 8);
  CHECK(count(page, "class=\"area ground\"") == 4);  // level ground and step, for two runs
  CHECK_THAT(page, !Catch::Contains("<script") && !Catch::Contains("<link") && !Catch::Contains("href=\"http") &&
                       !Catch::Contains("src=") && !Catch::Contains("nan"));
}

TEST_CASE("Paths that leave the vertical plane are shown from above too, less than 0.1 m beside a line is not") {
  const TemporaryFolder folder;
  make_dataset(folder / "real",
               {{"curve", 0, 0, 0, TestRun().columns, 0.5}, {"drive", 0, 0, 0, TestRun().columns, 0.2}});
  make_dataset(folder / "sim", {{"curve"}, {"drive"}});
  REQUIRE(kenaf_gap(folder, "compare real sim --out out").status == 0);
  const std::string page = read_file(folder / "out/compare.html");
  CHECK_THAT(page, Catch::Contains("from above, to scale"));
  CHECK(count(page, "<svg class=\"chart\"") == 9);
}

TEST_CASE("The start is aligned by default, and the offset is reported") {
  const TemporaryFolder folder;
  make_dataset(folder / "real", {{"drive"}});
  make_dataset(folder / "sim", {{"drive", 0, 0, 0.5}});
  REQUIRE(kenaf_gap(folder, "compare real sim --out aligned").status == 0);
  const json aligned = json::parse(read_file(folder / "aligned/compare.json"));
  CHECK(aligned["runs"][0]["start_offset"]["x_m"].get<double>() == Approx(-0.5));
  CHECK(aligned["runs"][0]["same_time"]["position_m"]["max"].get<double>() == Approx(0).margin(1e-9));
  REQUIRE(kenaf_gap(folder, "compare real sim --out raw --no-align-start").status == 0);
  const json raw = json::parse(read_file(folder / "raw/compare.json"));
  CHECK(raw["runs"][0]["start_offset"]["x_m"] == 0);
  CHECK(raw["runs"][0]["same_time"]["position_m"]["mean"].get<double>() == Approx(0.5));
}

TEST_CASE("Angles that were not measured are null and take nothing else away") {
  const TemporaryFolder folder;
  make_dataset(folder / "real", {{"drive", 0, 0, 0, "t_s,x_m,spare_a,z_m,spare_b,spare_c,spare_d"}});
  make_dataset(folder / "sim", {{"drive"}});
  REQUIRE(kenaf_gap(folder, "compare real sim --out out").status == 0);
  const json report = json::parse(read_file(folder / "out/compare.json"));
  CHECK(report["runs"][0]["matched"]["pitch_rad"]["mean"].is_null());
  CHECK(report["runs"][0]["start_offset"]["turned"] == false);
  CHECK(report["runs"][0]["matched"]["position_m"]["mean"].get<double>() == Approx(0).margin(1e-9));
  CHECK_THAT(read_file(folder / "out/compare.html"), Catch::Contains("not measured"));
}

TEST_CASE("A run without a height is compared in the ground plane, and its page shows it from above") {
  const TemporaryFolder folder;
  make_dataset(folder / "real", {{"drive", 0, 0, 0, "t_s,x_m,y_m,spare_a,spare_b,spare_c,yaw_rad"}});
  make_dataset(folder / "sim", {{"drive"}});
  REQUIRE(kenaf_gap(folder, "compare real sim --out out").status == 0);
  const json report = json::parse(read_file(folder / "out/compare.json"));
  CHECK(report["runs"][0]["plane"] == "ground");
  CHECK(report["runs"][0]["matched"]["position_m"]["max"].get<double>() == Approx(0).margin(1e-9));
  CHECK(report["runs"][0]["matched"]["pitch_rad"]["mean"].is_null());
  CHECK(report["runs"][0]["matched"]["yaw_rad"]["max"].get<double>() == Approx(0).margin(1e-9));
  const std::string page = read_file(folder / "out/compare.html");
  CHECK_THAT(page, Catch::Contains("norm of (x, y)") && Catch::Contains("from above, to scale") &&
                       Catch::Contains("Yaw, matched frames") && !Catch::Contains("nan"));
}

TEST_CASE("A run without a place is left out in words, with its counterpart, where none is left that is an error") {
  const TemporaryFolder folder;
  const TestRun blind{"blind", 0, 0, 0, "t_s,spare_a,y_m,spare_b,roll_rad,pitch_rad,yaw_rad"};
  make_dataset(folder / "real", {blind, {"drive"}});
  make_dataset(folder / "sim", {{"blind"}, {"drive"}});
  REQUIRE(kenaf_gap(folder, "compare real sim --out out").status == 0);
  const json report = json::parse(read_file(folder / "out/compare.json"));
  REQUIRE(report["left_out"].size() == 2);
  CHECK(report["left_out"][0]["why"] == "x_m was not measured");
  CHECK(report["left_out"][1]["why"] == "its counterpart run-0.csv cannot be compared");

  make_dataset(folder / "other", {blind});
  const Outcome nothing = kenaf_gap(folder, "compare other sim --out none");
  CHECK(nothing.status == 2);
  CHECK_THAT(nothing.error, Catch::Contains("no pair of runs can be compared") &&
                                Catch::Contains("real run-0.csv (blind): x_m was not measured"));
  CHECK_FALSE(fs::exists(folder / "none"));
}

TEST_CASE("A run whose numbers are in other units than its columns say is left out, and why is said") {
  const TemporaryFolder folder;
  make_dataset(folder / "real", {{"drive"}});
  make_dataset(folder / "sim", {{"drive"}});
  std::string millimetres = "t_s,x_m,y_m,z_m,cmd_track_left_mps,cmd_track_right_mps\n";
  for (int i = 0; i <= 80; ++i) {
    const double t_s = 0.05 * i;
    millimetres += fmt::format("{},{},0,100,0.2,0.2\n", t_s, 200 * t_s);
  }
  write_file(folder / "real/run-0.csv", millimetres);
  const Outcome outcome = kenaf_gap(folder, "compare real sim --out out");
  CHECK(outcome.status == 2);
  CHECK_THAT(outcome.error, Catch::Contains("real run-0.csv (drive): x_m") && Catch::Contains("millimetres"));
}

TEST_CASE("A world that does not load takes only the ground away") {
  const TemporaryFolder folder;
  make_dataset(folder / "real", {{"drive"}}, "mine.sdf");
  make_dataset(folder / "sim", {{"drive"}});
  REQUIRE(kenaf_gap(folder, "compare real sim --out out").status == 0);
  const std::string page = read_file(folder / "out/compare.html");
  CHECK_THAT(page, Catch::Contains("The ground is not drawn: ") && Catch::Contains("mine.sdf"));
  CHECK(count(page, "class=\"area ground\"") == 0);
}

TEST_CASE("Bad input: status 2, the place in words, and nothing written") {
  const TemporaryFolder folder;
  make_dataset(folder / "real", {{"drive"}});
  make_dataset(folder / "sim", {{"drive"}});
  const auto refused = [&folder](const std::string& arguments) {
    const Outcome outcome = kenaf_gap(folder, "compare " + arguments);
    CHECK(outcome.status == 2);
    CHECK_FALSE(fs::exists(folder / "out"));
    return outcome.error;
  };
  CHECK_THAT(refused("real nowhere --out out"), Catch::Contains("nowhere/dataset.toml: cannot be opened"));
  CHECK_THAT(refused("real sim"), Catch::Contains("--out"));
  CHECK_THAT(refused("real --out out"), Catch::Contains("SIM is required"));
  CHECK_THAT(refused("real sim --out out --band -1"), Catch::Contains("--band"));
  CHECK_THAT(refused("real sim --out out --start nan"), Catch::Contains("--start nan: must be a number from 0"));
  write_file(folder / "sim/run-0.csv", "t_s,x_m,z_m\n0,0,0\n1,oops,0\n");
  CHECK_THAT(refused("real sim --out out"), Catch::Contains("sim/run-0.csv:3:3: 'oops'"));
  write_file(folder / "sim/run-0.csv", "");
  CHECK_THAT(refused("real sim --out out"), Catch::Contains("sim/run-0.csv:1:1: the file is empty"));
  write_file(folder / "sim/run-0.csv", "t_s,x_m,z_m\n");
  CHECK_THAT(refused("real sim --out out"), Catch::Contains("sim run-0.csv (drive): has no rows"));
  write_file(folder / "sim/dataset.toml", "format = 3\n");
  CHECK_THAT(refused("real sim --out out"), Catch::Contains("sim/dataset.toml:1:10:"));
}

TEST_CASE("A folder that cannot be made or written is named") {
  const TemporaryFolder folder;
  make_dataset(folder / "real", {{"drive"}});
  write_file(folder / "file", "");
  const Outcome outcome = kenaf_gap(folder, "compare real real --out file/out");
  CHECK(outcome.status == 2);
  CHECK_THAT(outcome.error, Catch::Contains("file/out: cannot be created"));
  CHECK(kenaf_gap(folder, "compare real real --out file").status == 2);
}

TEST_CASE("Runs too long to match need a band, and the error names it") {
  const TemporaryFolder folder;
  make_dataset(folder / "long", {{"drive"}});
  std::string text = "t_s,x_m,z_m\n";
  for (int i = 0; i < 17000; ++i) text += std::to_string(i) + "e-2," + std::to_string(i) + "e-4,0\n";
  write_file(folder / "long/run-0.csv", text);
  const Outcome outcome = kenaf_gap(folder, "compare long long --out out");
  CHECK(outcome.status == 2);
  // 2^28 pairs over 17000 frames and both sides: 7894 frames of 10 ms
  CHECK_THAT(outcome.error, Catch::Contains("17000 x 17000") && Catch::Contains("--band SECONDS of at most 78.9"));
  CHECK(kenaf_gap(folder, "compare long long --out out --band 2").status == 0);
}
