// The playback page is given recorded runs under the rules of the live view (Host, Origin and token), and each run is
// made once, when somebody asks for it. Values at other times lie straight between measured cells, take the short way
// for angles and are empty in a hole; where no pose was measured, dead reckoning by tracks and yaw stands in for it. A
// long run is thinned, but keeps its first and last time. The expected poses, times, marks and phases come from small
// recorded files and their report; wrong input ends the program with status 2 and words, SIGTERM with 0.
#include "gap/playback/playback.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <thread>

#include "gap/diagnose/channels.hpp"
#include "gap/diagnose/report.hpp"
#include "gap/playback/columns_in_time.hpp"
#include "gap/playback/dead_reckoning.hpp"
#include "gap/playback/playback_path.hpp"
#include "gap/playback/playback_server.hpp"
#include "gap/playback/shelf.hpp"
#include "tests/gap/kenaf_gap.hpp"
#include "tests/gap/made_run.hpp"
#include "tests/server/live/web_client.hpp"

namespace kenaf::gap::playback {
namespace {

using nlohmann::json;
using test::ColumnOfTime;
using test::TemporaryFolder;
using PlayedTimes = std::vector<double>;

constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

double still(double) {
  return 0;
}
double go(double t_s) {
  return t_s < 0.5 ? 0 : 0.2;
}
double gone(double t_s) {
  return t_s < 0.5 ? 0 : 0.1 * (t_s - 0.5);
}

// 2 s at 100 Hz: commanded to go at 0.2 m/s from 0.5 s on, it goes at half of that.
runs::Run half_speed(bool with_pose) {
  std::vector<ColumnOfTime> columns{
      {"cmd_track_left_mps", go}, {"cmd_track_right_mps", go}, {"track_left_m", gone}, {"track_right_m", gone}};
  if (with_pose)
    columns.insert(columns.end(), {{"x_m", gone},
                                   {"y_m", still},
                                   {"z_m", [](double) { return 0.09; }},
                                   {"roll_rad", still},
                                   {"pitch_rad", still},
                                   {"yaw_rad", still}});
  return test::made_run(2, 0.01, columns);
}

constexpr const char* kReport = R"({"format": "kenaf-gap-report/1", "verdict": "named", "named": ["drive_lag"],
  "where": {"channels": [{"channel": "x_m", "share": 0.7}, {"channel": "z_m", "share": null}],
            "phases": [{"manoeuvre": "go", "run": "a.csv", "phase": "cruise", "from_s": 0.8, "to_s": 2, "share": 0.75},
                       {"manoeuvre": "go", "run": "a.csv", "phase": "stand", "from_s": 0, "to_s": 0.5, "share": 0.25}]}})";

// Two repeats of one manoeuvre, a third run without a pose, and a report of the first.
struct Recorded {
  TemporaryFolder folder;
  Recorded() {
    runs::write_run(folder / "a.csv", half_speed(true));
    runs::write_run(folder / "b.csv", half_speed(true));
    runs::write_run(folder / "c.csv", half_speed(false));
    runs::Dataset dataset{"real", "kenaf", "flat", "", {}, {}};
    dataset.runs = {{"a.csv", "go", ""}, {"b.csv", "go", ""}, {"c.csv", "blind", ""}};
    runs::write_dataset(folder.path(), dataset);
    std::filesystem::create_directory(folder / "report");
    std::ofstream(folder / "report/report.json") << kReport;
  }
  Playback load() const { return load_playback({folder.path(), folder / "report", "", "", ""}); }
};

std::string status(const std::string& answer) {
  return answer.substr(9, 3);
}

std::string body_of_answer(const std::string& answer) {
  return answer.substr(answer.find("\r\n\r\n") + 4);
}

}  // namespace

TEST_CASE("A column at other times lies between its cells, and has nothing in a hole") {
  runs::Run run{{"t_s", "x_m", "yaw_rad"}, {{5, 5.1, 5.2, 6.5}, {1, kNotMeasured, 3, 4}, {3.1, -3.1, -3.1, -3.1}}};
  const PlayedTimes times{0, 0.1, 0.15, 0.2, 0.5, 1.5, 1.6};
  // the cells are 0.2 s and 1.3 s apart: the median is 1.3 s of two, so no hole is longer than 3 times that
  const auto x = column_at(run, "x_m", times);
  CHECK(x[0] == 1);
  CHECK(x[1] == Approx(2));  // half way from 1 to 3
  CHECK(x[2] == Approx(2.5));
  CHECK(x[3] == 3);
  CHECK(x[5] == 4);
  CHECK(std::isnan(x[6]));  // after the last one
  // from 3.1 to -3.1 it is 2 pi - 6.2 = 0.0832 on, not 6.2 back
  CHECK(column_at(run, "yaw_rad", PlayedTimes{0.05})[0] == Approx(3.1 + (2 * std::numbers::pi - 6.2) / 2));
  CHECK(column_at(run, "z_m", times).empty());
  // 100 Hz, and nothing from 1 s to 2 s: a hole of 1 s, longer than 0.25 s
  const auto holed =
      test::made_run(3, 0.01, {{"x_m", [](double t_s) { return t_s > 1 && t_s < 2 ? kNotMeasured : t_s; }}});
  const auto through = column_at(holed, "x_m", PlayedTimes{0.505, 1.5, 2.5});
  CHECK(through[0] == Approx(0.505));
  CHECK(std::isnan(through[1]));
  CHECK(through[2] == Approx(2.5));
}

TEST_CASE("A long run is thinned") {
  const PlayedTimes eleven{3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13};
  CHECK(shown_times(eleven, 11) == PlayedTimes{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10});
  CHECK(shown_times(eleven, 4) == PlayedTimes{0, 3, 6, 10});  // every third, and the last
  CHECK(shown_times(PlayedTimes{7}, 4) == PlayedTimes{0});
}

TEST_CASE("Dead reckoning gives the path where no pose was measured") {
  const physics::RobotDescription kenaf = physics::load_robot("kenaf");
  const auto metre = [](double t_s) { return t_s; };
  const auto ahead = reckon(test::made_run(1.001, 0.01, {{"track_left_m", metre}, {"track_right_m", metre}}), kenaf);
  REQUIRE(ahead);
  CHECK(ahead->x_m.back() == Approx(0.99));
  CHECK(ahead->y_m.back() == Approx(0).margin(1e-9));
  // it looks left: y; by the tracks' speed of 1 m/s alone the same
  const auto one = [](double) { return 1.0; };
  const auto left = reckon(test::made_run(1.001, 0.01,
                                          {{"track_left_mps", one},
                                           {"track_right_mps", one},
                                           {"yaw_rad", [](double) { return std::numbers::pi / 2; }}}),
                           kenaf);
  REQUIRE(left);
  CHECK(left->y_m.back() == Approx(0.99));
  CHECK(left->x_m.back() == Approx(0).margin(1e-9));
  // the belts a quarter turn apart, as wide as they are: yaw is their difference by the gauge
  const double quarter_m = kenaf.track_gauge_m() * std::numbers::pi / 4;
  const auto turned = reckon(test::made_run(1.001, 0.01,
                                            {{"track_left_m", [&](double t_s) { return -quarter_m * t_s; }},
                                             {"track_right_m", [&](double t_s) { return quarter_m * t_s; }}}),
                             kenaf);
  CHECK(turned->yaw_rad.back() == Approx(0.99 * std::numbers::pi / 2));
  CHECK_FALSE(reckon(test::made_run(1, 0.01, {{"track_left_m", metre}}), kenaf));
}

TEST_CASE("Dead reckoning where tracks and angles have holes, or the angles are an INS's") {
  const physics::RobotDescription kenaf = physics::load_robot("kenaf");
  const auto metre = [](double t_s) { return t_s; };
  // encoders that count from 5 m and tell it from 0.1 s on: from 5.1 to 5.99 m
  const auto late = [](double t_s) { return t_s < 0.095 ? kNotMeasured : 5 + t_s; };
  const auto begun = reckon(test::made_run(1.001, 0.01, {{"track_left_m", late}, {"track_right_m", late}}), kenaf);
  REQUIRE(begun);
  CHECK(begun->x_m.back() == Approx(0.89));
  // the sensor's zero is anywhere: the run begins along x, and turns by a quarter while it goes from 0.5 m on
  const auto turned =
      reckon(test::made_run(2.001, 0.01,
                            {{"track_left_m", metre},
                             {"track_right_m", metre},
                             {"posture_yaw_rad", [](double t_s) { return t_s < 0.5 ? 2 : 2 + std::numbers::pi / 2; }}}),
             kenaf);
  REQUIRE(turned);
  CHECK(turned->yaw_rad.front() == 0);
  CHECK(turned->yaw_rad.back() == Approx(std::numbers::pi / 2).margin(1e-3));
  CHECK(turned->x_m.back() == Approx(0.5).margin(0.06));  // smoothed over 0.05 s, at 1 m/s
  CHECK(turned->y_m.back() == Approx(1.49).margin(0.06));
  // twice a second, at 0.5 rad/s: 1.75 rad at 3.5 s, which is the last one; belts alone know of no turn
  const auto slow =
      reckon(test::made_run(
                 4.001, 0.01,
                 {{"track_left_m", metre},
                  {"track_right_m", metre},
                  {"yaw_rad",
                   [](double t_s) { return std::abs(std::remainder(t_s, 0.5)) < 1e-6 ? 0.5 * t_s : kNotMeasured; }}}),
             kenaf);
  REQUIRE(slow);
  CHECK(slow->yaw_rad.back() == Approx(1.75).margin(0.03));
}

TEST_CASE("A report's phases belong to their run, or to its one repeat that the report has") {
  const ReportedPlaces places = parse_reported_places(kReport);
  CHECK(places.verdict == "named");
  CHECK(places.named == std::vector<std::string>{"drive_lag"});
  CHECK(places.channel_share.at("x_m") == 0.7);
  CHECK(places.channel_share.at("z_m") == 0);
  CHECK(places.stage.empty());
  const std::map<std::string, std::string> one_world{{"a.csv", "flat"}, {"b.csv", "flat"}};
  CHECK(phases_of_run(places, "a.csv", "go", one_world).size() == 2);
  CHECK(phases_of_run(places, "b.csv", "go", one_world).at(0).run == "a.csv");  // its repeat
  CHECK(phases_of_run(places, "b.csv", "turn", one_world).empty());
  CHECK(phases_of_run(places, "b.csv", "go", {{"a.csv", "flat"}, {"b.csv", "hills"}}).empty());
  ReportedPlaces two = places;
  two.phases[1].run = "d.csv";  // the report tells b.csv's commands from both
  CHECK(phases_of_run(two, "b.csv", "go", {{"a.csv", "flat"}, {"b.csv", "flat"}, {"d.csv", "flat"}}).empty());
  for (const char* wrong : {"", "[]", "{\"format\": \"kenaf-gap-report/2\"}", "{\"format\": \"kenaf-gap-report/3\"}",
                            R"({"format": "kenaf-gap-report/1", "verdict": "none", "named": [], "where": {}})"})
    CHECK_THROWS_WITH(parse_reported_places(wrong), Catch::Contains("not the report of a diagnosis"));
  std::string backwards = kReport;
  backwards.replace(backwards.find("\"to_s\": 2"), 9, "\"to_s\": 0");
  CHECK_THROWS_WITH(parse_reported_places(backwards), Catch::Contains("from 0.8 s to 0 s"));
}

TEST_CASE("Floors are the report's, else the dataset's noise, else the least that counts") {
  const ReportedPlaces places =
      parse_reported_places(R"({"format": "kenaf-gap-report/2", "verdict": "none", "named": [],
    "where": {"stage": "drive to body",
              "channels": [{"channel": "x_m", "share": 0.7, "floor": 0.004}, {"channel": "y_m", "share": 0, "floor": null},
                           {"channel": "z_m", "share": 0, "floor": 0}], "phases": []},
    "stages": [{"where": {"channels": [{"channel": "track_left_mps", "share": 1, "floor": 0.02}], "phases": []}}]})");
  CHECK(places.stage == "drive to body");
  const std::map<std::string, double> noise{{"x_m", 0.1}, {"y_m", 0.003}, {"z_m", 1e-9}};
  const auto floors = floors_of(noise, &places);
  CHECK(floors.at("x_m").value == 0.004);
  CHECK(floors.at("x_m").from == FloorFrom::report);
  CHECK(floors.at("track_left_mps").value == 0.02);  // of another stage than the one with most of the gap
  CHECK(floors.at("y_m").value == 0.003);
  CHECK(floors.at("y_m").from == FloorFrom::stated_noise);
  CHECK(floors.at("z_m").value > 1e-9);  // a noise below what a diagnosis counts is no floor
  CHECK(floors.at("z_m").from == FloorFrom::resolution);
  CHECK(floors_of({}, nullptr).at("x_m").from == FloorFrom::resolution);
}

TEST_CASE("A run's gap is counted in floors, by means over quarters of a second, and is worst where all are together") {
  // one second at 100 Hz: x is off by 20 mm in the third quarter and by 10 mm in the fourth; yaw by 2 pi - 6.2 across
  // pi
  const double across = 2 * std::numbers::pi - 6.2;
  const runs::Run recorded = test::made_run(
      1, 0.01, {{"x_m", [](double) { return 1.0; }}, {"yaw_rad", [](double) { return 3.1; }}, {"z_m", [](double) {
                                                                                                 return kNotMeasured;
                                                                                               }}});
  const auto ahead = [](double t_s) { return t_s < 0.495 ? 1 : t_s < 0.745 ? 1.02 : 1.01; };
  // y was not recorded
  const runs::Run simulated = test::made_run(
      1, 0.01, {{"x_m", ahead}, {"yaw_rad", [](double) { return -3.1; }}, {"z_m", still}, {"y_m", ahead}});
  std::map<std::string, Floor> floors = floors_of({}, nullptr);
  floors["x_m"].value = 0.005;
  floors["yaw_rad"].value = across / 2;
  const diagnose::RunGap gap = gap_of_run(recorded, simulated, floors);
  REQUIRE(gap.channels.size() == 2);
  const diagnose::ChannelCourse &x = gap.channels[0], &yaw = gap.channels[1];
  REQUIRE(x.difference.size() == 4);
  // measured minus simulated
  for (const auto& [span, expected_m] : {std::pair{0, 0.0}, {1, 0.0}, {2, -0.02}, {3, -0.01}})
    CHECK(x.difference[static_cast<std::size_t>(span)] == Approx(expected_m).margin(1e-12));
  CHECK(x.rms == Approx(std::sqrt(5)));  // 0, 0, 4 and 2 floors
  CHECK(yaw.rms == Approx(2));
  CHECK(gap.rms == Approx(std::sqrt(4.5)));
  REQUIRE(gap.worst);
  const diagnose::RunMoment& worst = *gap.worst_moment();
  CHECK(worst.at_s == 0.625);
  CHECK(worst.times_noise == Approx(std::sqrt(10)));  // 4 floors of x and 2 of yaw
  CHECK(diagnose::diagnosis_channels()[worst.channels[0].channel].column == "x_m");
  CHECK(worst.channels[0].measured == Approx(1));
  CHECK(worst.channels[0].simulated == Approx(1.02));
  CHECK(worst.channels[0].difference() == Approx(-0.02));
  CHECK(worst.channels[0].times_noise == Approx(4));
  // nothing in common: no worst moment
  CHECK_FALSE(gap_of_run(recorded, test::made_run(1, 0.01, {{"track_left_a", still}}), floors).worst);
}

TEST_CASE("A last sample alone in its quarter of a second has the noise of one, and is not the worst moment for it") {
  // x is off by 20 mm in the third quarter, by 30 mm in the one sample at 1 s: 4 floors, and 6 by a fifth
  const runs::Run recorded = test::made_run(1.011, 0.01, {{"x_m", [](double) { return 1.0; }}});
  const auto ahead = [](double t_s) { return t_s < 0.495 ? 1 : t_s < 0.745 ? 1.02 : t_s < 0.995 ? 1 : 1.03; };
  const runs::Run simulated = test::made_run(1.011, 0.01, {{"x_m", ahead}});
  REQUIRE(recorded.row_count() == 101);
  std::map<std::string, Floor> floors = floors_of({}, nullptr);
  floors["x_m"].value = 0.005;
  const diagnose::RunGap gap = gap_of_run(recorded, simulated, floors);
  REQUIRE(gap.moments.size() == 5);
  CHECK(gap.moments[4].at_s == Approx(1));
  CHECK(gap.moments[4].times_noise == Approx(1.2));
  CHECK(gap.worst_moment()->at_s == 0.625);
}

TEST_CASE("A report and a playback of the same run have the same worst moment, with the same figures") {
  const Recorded recorded;
  diagnose::Diagnosis d;
  std::vector<std::string> notes;
  d.observations.robot = physics::load_robot("kenaf");
  d.observations.worlds.push_back(physics::load_world("flat", notes));
  d.observations.runs.push_back(
      diagnose::observation_of({"a.csv", "go", ""}, runs::read_run(recorded.folder / "a.csv"), "a.csv"));
  d.features = diagnose::compared_features(d.observations, d.options.span_s);
  d.repeats = {{0}};
  const json of_report = json::parse(diagnose::diagnosis_json(d, diagnose::compared_runs(d, {})))["runs"];
  REQUIRE(of_report.size() == 1);
  CHECK(of_report[0]["run"] == "a.csv");
  CHECK(of_report[0]["times_noise_corrected"].is_null());
  const json& worst = of_report[0]["worst"];

  const Playback playback = load_playback({recorded.folder / "a.csv", "", "", "", ""});
  const json played = json::parse(played_run_json(playback, 0, prepare_run(playback, 0)))["gaps"][0]["worst"];
  CHECK(played["t_s"] == worst["at_s"]);
  CHECK(played["column"] == worst["channel"]);
  for (const auto& [of_page, in_report] : {std::pair{"floors", "times_noise"},
                                           {"recorded", "measured"},
                                           {"simulated", "simulated"},
                                           {"difference", "difference"},
                                           {"difference_floors", "channel_times_noise"}})
    CHECK(played[of_page].get<double>() == Approx(worst[in_report].get<double>()).epsilon(1e-4).margin(1e-6));
  CHECK(worst["difference"].get<double>() ==
        Approx(worst["measured"].get<double>() - worst["simulated"].get<double>()));
}

TEST_CASE("A playback begins with the run that has the worst moment of all, unless it is told where to begin") {
  const Recorded recorded;
  std::string report = kReport;
  report.pop_back();
  const auto with_runs = [&](const std::string& runs) {
    std::ofstream(recorded.folder / "report/report.json") << report << ", \"runs\": [" << runs << "]}";
    return recorded.load();
  };
  const std::string a = R"({"run": "a.csv", "worst": {"at_s": 1.9, "times_noise": 7}})",
                    b = R"({"run": "b.csv", "worst": {"at_s": 1.4, "times_noise": 12.5}})",
                    c = R"({"run": "c.csv", "worst": null})";
  const Playback playback = with_runs(a + "," + b + "," + c);
  CHECK(playback.first == 1);
  const json list = json::parse(playback_json(playback));
  CHECK(list["first"] == 1);
  CHECK(list["runs"][0]["worst"] == json{{"t_s", 1.9}, {"floors", 7.0}});
  CHECK(list["runs"][1]["worst"]["floors"] == 12.5);
  CHECK_FALSE(list["runs"][2].contains("worst"));
  CHECK(load_playback({recorded.folder.path(), recorded.folder / "report", "go", "", ""}).first == 0);
  CHECK(load_playback({recorded.folder.path(), recorded.folder / "report", "", "", "", 1.5}).first == 0);
  CHECK(with_runs("").first == 0);
  CHECK(with_runs(R"({"run": "b.csv", "worst": {"at_s": null, "times_noise": 3}})").first == 0);
}

TEST_CASE("A report is given by its folder or by its file") {
  const Recorded recorded;
  const auto load = [&](const std::filesystem::path& report) {
    return load_playback({recorded.folder.path(), report, "", "", ""});
  };
  std::filesystem::copy_file(std::string(KENAF_SOURCE_DIR) + "/share/robots/kenaf.toml",
                             recorded.folder / "report/robot.toml");
  CHECK(load(recorded.folder / "report/report.json").report->verdict == "named");
  CHECK(load(recorded.folder / "report/report.json").robots.corrected);
  CHECK_THROWS_WITH(load(recorded.folder / "report/page.json"), Catch::Contains("there is no report.json"));
}

TEST_CASE("A page is told a run's poses, times and marks as they were recorded") {
  const Recorded recorded;
  const Playback playback = recorded.load();
  const json list = json::parse(playback_json(playback));
  CHECK(list["format"] == "kenaf-playback/2");
  CHECK(list["runs"].size() == 3);
  CHECK(list["runs"][1] == json{{"file", "b.csv"},
                                {"manoeuvre", "go"},
                                {"world", "flat"},
                                {"rows", 200},
                                {"duration_s", 1.99},
                                {"share", 1.0}});
  CHECK(list["report"]["named"][0] == "drive_lag");
  CHECK(list["report"]["largest_share"] == 0.75);
  CHECK(list["at_s"] == 0);
  CHECK(list["robot"]["flipper"]["length"] > 0);

  const json run = json::parse(played_run_json(playback, 0, prepare_run(playback, 0)));
  REQUIRE(run["t_s"].size() == 200);
  CHECK(run["t_s"][150] == 1.5);
  REQUIRE(run["bodies"].size() == 2);  // the report has no robot.toml
  const json& real = run["bodies"][0];
  CHECK(real["kind"] == "recorded");
  CHECK(real["pose_from"] == "measured");
  CHECK(real["pose"]["x"][150] == 0.1);  // 1 s at 0.1 m/s
  CHECK(real["pose"]["z"][0] == 0.09);
  CHECK(real["track_m"][0][150] == 0.1);
  CHECK(real["channels"]["x_m"] == real["pose"]["x"]);
  const json& nominal = run["bodies"][1];
  CHECK(nominal["kind"] == "nominal");
  CHECK(nominal["pose"]["x"].size() == 200);
  CHECK(nominal["pose"]["x"][0].get<double>() == Approx(0).margin(0.002));
  // it obeys: 1.49 s at 0.2 m/s, less what it needs to get there and the sinking of belts
  CHECK(nominal["pose"]["x"][199].get<double>() == Approx(0.29).margin(0.02));
  CHECK(run["marks"].size() == 2);
  CHECK(
      run["marks"][0] ==
      json{{"manoeuvre", "go"}, {"phase", "cruise"}, {"run", "a.csv"}, {"from_s", 0.8}, {"to_s", 2}, {"share", 0.75}});
  CHECK(run["phases"][0]["phase"] == "stand");
  CHECK(run["phases"][0]["to_s"].get<double>() == Approx(0.5).margin(0.051));
  CHECK(run["channels"][0].contains("column"));
  CHECK(run["channels"][0]["floor"] > 0);
  CHECK(run["channels"][0]["floor_from"] == "resolution");  // the report of version 1 has none
  // the nominal robot goes 0.1 m/s faster, so it is farthest ahead in the last quarter of a second
  REQUIRE(run["gaps"].size() == 1);
  const json& gap = run["gaps"][0];
  CHECK(gap["kind"] == "nominal");
  CHECK(gap["span_s"] == 0.25);
  CHECK(gap["differences"]["x_m"].size() == 8);
  CHECK(gap["difference_floors"]["x_m"].size() == 8);
  CHECK(gap["differences"]["x_m"][0].get<double>() == Approx(0).margin(0.002));
  CHECK(gap["worst"]["t_s"] == 1.875);
  CHECK(gap["worst"]["column"] == "x_m");
  CHECK(gap["worst"]["difference"].get<double>() ==
        Approx(-0.13).margin(
            0.025));  // measured minus simulated; 1.37 s after the start, less what it needs to get going
  CHECK(run["notes"].empty());
}

TEST_CASE("Without a pose the page receives a note, and the position by dead reckoning") {
  const Recorded recorded;
  const Playback playback = recorded.load();
  const json run = json::parse(played_run_json(playback, 2, prepare_run(playback, 2)));
  CHECK(run["bodies"][0]["pose_from"] == "dead reckoning");
  CHECK(run["bodies"][0]["pose"]["x"][150].get<double>() == Approx(0.1));
  CHECK_FALSE(run["bodies"][0]["channels"].contains("x_m"));  // it was not measured
  CHECK(run["bodies"].size() == 2);
  CHECK(run["marks"].empty());
  CHECK(run["notes"][0].get<std::string>().find("dead reckoning") != std::string::npos);

  // what is called recorded is the file's, also where dead reckoning makes another of it: 0.1 rad/s for 1.5 s
  runs::Run turning = half_speed(false);
  turning.columns.emplace_back("yaw_rad");
  turning.values.emplace_back();
  for (const double t_s : turning.column("t_s")) turning.values.back().push_back(0.1 * t_s);
  runs::write_run(recorded.folder / "yaw.csv", turning);
  const Playback heading = load_playback({recorded.folder / "yaw.csv", "", "", "", ""});
  const json with_yaw = json::parse(played_run_json(heading, 0, prepare_run(heading, 0)));
  CHECK(with_yaw["bodies"][0]["pose_from"] == "dead reckoning");
  CHECK(with_yaw["bodies"][0]["channels"]["yaw_rad"][150].get<double>() == Approx(0.15));
  CHECK_FALSE(with_yaw["bodies"][0]["channels"].contains("x_m"));

  // nothing at all: the file still plays, by itself, with its simulation left out and why
  runs::write_run(recorded.folder / "only-currents.csv", test::made_run(1, 0.1, {{"track_left_a", still}}));
  const Playback alone = load_playback({recorded.folder / "only-currents.csv", "", "", "", ""});
  CHECK(alone.notes.front().find("flat") != std::string::npos);
  const json bare = json::parse(played_run_json(alone, 0, prepare_run(alone, 0)));
  CHECK(bare["bodies"].size() == 1);
  CHECK(bare["bodies"][0]["pose_from"] == "nothing");
  CHECK(bare["notes"].dump().find("no commands") != std::string::npos);
}

TEST_CASE("A corrected robot beside the nominal one, and a file that its dataset knows") {
  const Recorded recorded;
  std::ofstream(recorded.folder / "report/robot.toml")
      << std::ifstream(std::string(KENAF_SOURCE_DIR) + "/share/robots/kenaf.toml").rdbuf()
      << "\n[effects.command_delay]\ndelay_s = 0.3\n";
  const Playback playback = load_playback({recorded.folder / "a.csv", recorded.folder / "report", "", "", ""});
  CHECK(playback.runs.size() == 1);
  CHECK(playback.runs[0].entry.manoeuvre == "go");
  CHECK(load_playback({recorded.folder.path(), "", "blind", "", "", 1.5}).at_s == 1.5);
  const json run = json::parse(played_run_json(playback, 0, prepare_run(playback, 0)));
  REQUIRE(run["bodies"].size() == 3);
  CHECK(run["bodies"][2]["kind"] == "corrected");
  // 0.3 s at 0.2 m/s behind the nominal one
  const double behind =
      run["bodies"][1]["pose"]["x"][199].get<double>() - run["bodies"][2]["pose"]["x"][199].get<double>();
  CHECK(behind == Approx(0.06).margin(0.005));
}

TEST_CASE("What is made is made once and kept, and a failure is reported and tried again") {
  std::atomic<int> made = 0;
  Shelf shelf(10, [&](std::size_t n) {
    if (++made == 2) throw std::runtime_error("out of order");
    return std::string(6, static_cast<char>('0' + n));
  });
  const auto wait_for = [&](std::size_t n) {
    for (int i = 0; i < 2000; ++i) {
      const Shelf::Look look = shelf.look(n);
      if (look.text || !look.failure.empty()) return look;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    FAIL("waited 20 s");
    return Shelf::Look{};
  };
  CHECK(*wait_for(3).text == "333333");
  CHECK(*wait_for(3).text == "333333");
  CHECK(made == 1);
  CHECK(wait_for(4).failure == "out of order");
  CHECK(*wait_for(4).text == "444444");  // 12 bytes are more than 10: the older one went
  CHECK(made == 3);
  wait_for(3);
  CHECK(made == 4);
}

TEST_CASE("A page may ask for the list, a run and its scene, and nothing else") {
  const auto path = [](std::string_view text) {
    const auto found = parse_playback_path(text);
    if (!found) return std::string("none");
    return (found->run ? std::to_string(*found->run) : "list") + (found->scene ? " scene" : "");
  };
  CHECK(path("") == "list");
  CHECK(path("/3") == "3");
  CHECK(path("/12/scene") == "12 scene");
  for (const char* none :
       {"/", "3", "//3", "/-1", "/+1", "/ 1", "/3/", "/3/scenes", "/scene", "/3scene", "/99999999999999999999"})
    CHECK(path(none) == "none");
}

TEST_CASE("A page asks for the list, a run and its world, by the rules of the live view") {
  const Recorded recorded;
  PlaybackServer server(recorded.load(), {true, "127.0.0.1", 0, "sesame"});
  CHECK(server.url().ends_with("/#token=sesame"));
  const auto answer_to = [&](const std::string& request) {
    live::WebClient client(server.port());
    client.send(request);
    return client.answer();
  };
  const std::string page = answer_to(live::get("/"));
  CHECK(status(page) == "200");
  CHECK(page.find("Kenaf playback") != std::string::npos);
  CHECK(page.find("default-src 'none'") != std::string::npos);
  CHECK(status(answer_to(live::get("/playback.js"))) == "200");
  CHECK(status(answer_to(live::get("/playback"))) == "401");
  CHECK(status(answer_to(live::get("/playback?token=sesame", "Origin: http://evil.example\r\n"))) == "403");
  CHECK(status(answer_to("GET /playback?token=sesame HTTP/1.1\r\nHost: evil.example\r\n\r\n")) == "403");
  CHECK(json::parse(body_of_answer(answer_to(live::get("/playback?token=sesame"))))["runs"].size() == 3);
  CHECK(body_of_answer(answer_to(live::get("/playback/2/scene?token=sesame"))).starts_with("KNV1"));
  for (const char* path : {"/playback/3", "/playback/", "/playback/-1", "/playback/0x", "/playback/0/robot",
                           "/playback/99999999999999999999", "/ws", "/scene"})
    CHECK(status(answer_to(live::get(std::string(path) + "?token=sesame"))) == "404");
  std::string run = answer_to(live::get("/playback/1?token=sesame"));
  for (int i = 0; status(run) == "202" && i < 2000; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    run = answer_to(live::get("/playback/1?token=sesame"));
  }
  CHECK(status(run) == "200");
  CHECK(json::parse(body_of_answer(run))["file"] == "b.csv");
  std::filesystem::remove(recorded.folder / "c.csv");
  std::string gone_file = answer_to(live::get("/playback/2?token=sesame"));
  for (int i = 0; status(gone_file) == "202" && i < 2000; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    gone_file = answer_to(live::get("/playback/2?token=sesame"));
  }
  CHECK(status(gone_file) == "500");
  CHECK(gone_file.find("c.csv") != std::string::npos);
}

TEST_CASE("kenaf-gap play says what is wrong, and ends when it is told to") {
  const Recorded recorded;
  std::ofstream(recorded.folder / "bad.csv") << "t_s,x_m\n0,1\n0,2\n";
  std::filesystem::create_directory(recorded.folder / "other");
  std::string other = kReport;
  for (std::size_t at = 0; (at = other.find("\"go\"", at)) != other.npos;) other.replace(at, 4, "\"dance\"");
  std::ofstream(recorded.folder / "other/report.json") << other;
  const std::vector<std::pair<std::string, std::string>> wrong{
      {"play", "RUNS is required"},
      {"play nowhere", "nowhere"},
      {"play bad.csv", "bad.csv:3:"},
      {"play . --report .", "there is no report.json"},
      {"play . --report other", "covers none of the manoeuvres"},
      {"play . --run d.csv", "contains neither a file nor a manoeuvre of that name"},
      {"play . --at 5", "--at 5: a.csv goes from 0 to 1.99 s"},
      {"play . --at -1", "must be a number from 0"},
      {"play . --robot nobody", "nobody"},
      {"play . --view here", "ADDRESS:PORT"},
      {"play . --view off", "nothing to do"},
      {"play . --view-token a=b", "letters"},
  };
  for (const auto& [arguments, words] : wrong) {
    INFO(arguments);
    const test::Outcome outcome = test::kenaf_gap(recorded.folder, arguments);
    CHECK(outcome.status == 2);
    CHECK(outcome.error.find(words) != std::string::npos);
  }
  const std::string script = "cd '" + recorded.folder.path().string() +
                             "' && { '" KENAF_GAP
                             "' play . --view 127.0.0.1:0 >printed.txt 2>&1 & p=$!; for i in $(seq 400); do "
                             "grep -q http printed.txt && break; sleep 0.05; done; kill -TERM $p; wait $p; }";
  CHECK(WEXITSTATUS(std::system(script.c_str())) == 0);
  CHECK(test::read_file(recorded.folder / "printed.txt").starts_with("http://127.0.0.1:"));
}

}  // namespace kenaf::gap::playback
