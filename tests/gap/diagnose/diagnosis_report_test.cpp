// The text, report.json and the robots of a diagnosis that was made by hand.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "formats/description/data_files.hpp"
#include "gap/diagnose/report.hpp"
#include "gap/diagnose/report_words.hpp"
#include "gap/playback/reported_places.hpp"
#include "tests/formats/runs/temporary_folder.hpp"
#include "tests/gap/diagnose/made_diagnosis.hpp"

using namespace kenaf;
using namespace kenaf::gap;
using namespace kenaf::gap::diagnose;
using namespace kenaf::gap::playback;
using namespace kenaf::test;
using Catch::Contains;
using Catch::StartsWith;
using nlohmann::json;

namespace {

json json_of(const Diagnosis& d) {
  return json::parse(diagnosis_json(d, compared_runs(d, {})));
}

// Nothing of it can be drawn, so that writing it simulates nothing.
Diagnosis undrawn(Diagnosis d) {
  d.repeats.clear();
  for (StageDiagnosis& stage : d.stages) stage.where.phases.clear();
  return d;
}

physics::RobotDescription robot_in(const std::string& toml) {
  return physics::parse_robot(toml, "robot.toml");
}

}  // namespace

TEST_CASE("A report has every stage with its verdict, values, gap and what is left") {
  const json report = json_of(made_diagnosis());
  CHECK(report["format"] == "kenaf-gap-report/2");
  CHECK(report["verdict"] == "named");
  CHECK(report["named"] == json{"drive_lag"});
  CHECK(report["ambiguous_sets"].empty());
  CHECK(report["complete"] == false);
  CHECK(report["robot_file"] == "robot.toml");
  REQUIRE(report["stages"].size() == 2);
  const json &drive = report["stages"][0], &body = report["stages"][1];
  CHECK(drive["stage"] == "command to drive");
  CHECK(drive["verdict"] == "named");
  CHECK(drive["named"] == json{"drive_lag"});
  CHECK(drive["explains"] == 0.85);
  CHECK(drive["explains_ci95"] == json{0.81, 0.88});
  CHECK(drive["gap"]["before"] == 8.25);
  CHECK(drive["gap"]["after"] == 1.5);
  CHECK(drive["gap"]["floor"] == 1.25);
  CHECK(drive["gap"]["shrink"] == 0.964);
  CHECK(drive["gap"]["shrink_by_manoeuvre"] == 0.87);
  CHECK(drive["gap"]["before_si"] == json{{"track_left_mps", 0.05}});
  CHECK(drive["gap"]["after_si"] == json{{"track_left_mps", 0.0123}});
  CHECK(drive["gap"]["heldout_runs"] == json{"run-000.csv", "run-001.csv", "run-002.csv"});
  const json& lag = drive["effects"][0];
  CHECK(lag["name"] == "drive_lag");
  CHECK(lag["parameters"]["lag_s"]["value"] == 0.0513);
  CHECK(lag["parameters"]["lag_s"]["ci95"] == json{0.0498, 0.0528});
  CHECK(lag["parameters"]["lag_s"]["spread"] == 0);
  CHECK(lag["explains"] == 0.85);
  CHECK(lag["heldout_shrink"] == 0.964);
  CHECK(lag["heldout_shrink_ci95"] == json{0.91, 0.99});
  CHECK(lag["at_bound"] == false);
  CHECK(lag["is_named"] == true);
  CHECK(drive["left"]["share"].get<double>() == Approx(0.15));
  CHECK(drive["left"]["depends_on"][0]["channel"] == "yaw rate");
  CHECK(drive["left"]["depends_on"][0]["on"] == "turn rate");
  CHECK(drive["left"]["depends_on"][0]["share"] == 0.84);
  CHECK(drive["left"]["depends_on"][0]["words"] == made_dependence().words);
  CHECK(drive["left"]["depends_on"][0]["look_at"] == json{"track.separation_m", "friction_across"});

  CHECK(body["verdict"] == "unknown");
  CHECK(body["named"].empty());
  CHECK(body["effects"][0]["is_named"] == false);
  CHECK(body["effects"][0]["parameters"].begin()->at("spread") == 0.02);
  CHECK(body["effects"][0]["doubts"] == json{"the values fitted to single manoeuvres differ by more than it"});
  CHECK(report["doubts"] ==
        json{"not named: com_forward (drive to body): the values fitted to single manoeuvres differ by more than it"});
}

TEST_CASE("The keys of version 1 are at the top of a report: of the stage with most of the gap, effects of all") {
  const json report = json_of(made_diagnosis());
  CHECK(report["where"]["stage"] == "command to drive");
  CHECK(report["where"]["channels"][0]["channel"] == "track_left_mps");
  CHECK(report["where"]["phases"][0]["run"] == "run-002.csv");
  CHECK(report["where"]["stages"].size() == 2);
  CHECK(report["gap"] == report["stages"][0]["gap"]);
  CHECK(report["ranking"] == report["stages"][0]["ranking"]);
  CHECK(report["isolability"]["effects"] == json{"drive_lag", "com_forward", "ground_slope"});
  CHECK(report["isolability"]["angle_deg"][1][2] == 4.2);
  REQUIRE(report["effects"].size() == 2);
  CHECK(report["effects"][0]["stage"] == "command to drive");
  CHECK(report["effects"][1]["stage"] == "drive to body");
  CHECK(report["warnings"].size() == 1);
  const ReportedPlaces places = parse_reported_places(report.dump());
  CHECK(places.named == std::vector<std::string>{"drive_lag"});
  CHECK(places.phases.size() == 2);
}

TEST_CASE("Effects that explain enough only together are a set of which several may act") {
  Diagnosis d = made_ambiguous();
  StageDecision& decision = d.stages[0].decision;
  decision.effects = {made_effect(com_forward, {-0.02, -0.03, -0.01}, 0.1),
                      made_effect(ground_slope, {0.1, 0, 0.2}, 0)};
  decision.effects[0].rivals = {com_forward, ground_slope};
  decision.effects[0].partners = {1};
  decision.effects[1].rivals = {ground_slope, com_forward};
  decision.effects[1].partners = {0};
  CHECK(json_of(d)["ambiguous_sets"] == json::array({json::array({"com_forward", "ground_slope"})}));
  CHECK_THAT(headline(d), StartsWith("com_forward, ground_slope or both explain 85 % of the gap from command to drive, "
                                     "but these runs cannot tell which"));
  decision.effects[0].rivals.push_back(track_separation);
  CHECK_THAT(headline(d), StartsWith("com_forward, ground_slope, track.separation_m or several of them explain 85 %"));
}

TEST_CASE("Every verdict has its report and its first line") {
  const auto verdict_of = [](const Diagnosis& d, const std::string& word, const std::string& first_line) {
    const json report = json_of(d);
    CHECK(report["verdict"] == word);
    CHECK_THAT(diagnosis_text(d), Catch::StartsWith(first_line + "\n"));
    return report;
  };
  const json none = verdict_of(made_without_gap(), "none",
                               "NONE: No gap: robot and simulation differ by no more than noise and repeated runs do");
  CHECK(none["complete"] == true);
  CHECK(none["where"]["stage"].is_null());
  CHECK(none["robot_file"].is_null());
  CHECK(none["stages"][0]["explains"].is_null());
  CHECK(none["stages"][0]["complete"] == true);

  const json ambiguous =
      verdict_of(made_ambiguous(), "ambiguous",
                 "AMBIGUOUS: One of com_forward or ground_slope explains 85 % of the gap from command "
                 "to drive, but\n  these runs cannot tell which");
  CHECK(ambiguous["named"].empty());
  CHECK(ambiguous["ambiguous_sets"] == json::array({json::array({"com_forward", "ground_slope"})}));
  CHECK(ambiguous["next_manoeuvres"][0]["manoeuvre"] == "turn-in-place");
  CHECK(ambiguous["next_manoeuvres"][0]["separates"] == json{"com_forward", "ground_slope"});
  CHECK(ambiguous["next_manoeuvres"][0]["expected_score"] == 7.4);

  const json unknown =
      verdict_of(made_unknown(), "unknown", "UNKNOWN: There is a gap from drive to body, and no effect is named");
  CHECK(unknown["robot_file"] == "robot.candidate.toml");
  CHECK(unknown["effects"].size() == 1);
  const json empty = verdict_of(made_unknown_without_model(), "unknown",
                                "UNKNOWN: There is a gap from drive to body, and no effect is named");
  CHECK(empty["robot_file"].is_null());
  CHECK(empty["stages"][0]["explains"] == 0);
  CHECK(empty["stages"][0]["left"]["share"] == 1);
}

TEST_CASE("Shares are never above 1, and what is not a number is null") {
  Diagnosis d = made_diagnosis();
  StageDiagnosis& stage = d.stages[0];
  stage.gap.explains = {1.2, 0.9, 1.4};
  stage.decision.effects[0].share.of_stage = 1.1;
  stage.left_over[0].share = 1.3;
  stage.gap.shrink = {std::nan(""), -std::numeric_limits<double>::infinity(), std::nan("")};
  stage.ranking[0].explains = 1.01;
  const json of_stage = json_of(d)["stages"][0];
  CHECK(of_stage["explains"] == 1);
  CHECK(of_stage["explains_ci95"] == json{0.9, 1.0});
  CHECK(of_stage["effects"][0]["explains"] == 1);
  CHECK(of_stage["left"]["share"] == 0);
  CHECK(of_stage["left"]["depends_on"][0]["share"] == 1);
  CHECK(of_stage["ranking"][0]["explains"] == 1);
  CHECK(of_stage["gap"]["shrink"].is_null());
  CHECK(of_stage["gap"]["shrink_ci95"] == json{nullptr, nullptr});
}

TEST_CASE("A name that is found in two stages is named once, and one number of the description by its key") {
  Diagnosis d = made_diagnosis();
  d.stages[1].decision.verdict = Verdict::named;
  d.stages[1].decision.effects = {made_effect(drive_lag, {0.05, 0.04, 0.06}, 0.3),
                                  made_effect(track_separation, {0.5, 0.49, 0.51}, 0.2)};
  d.stages[1].decision.best.model.places = {{drive_lag, 0.05}, {track_separation, 0.5}};
  const json report = json_of(d);
  CHECK(report["named"] == json{"drive_lag", "track.separation_m"});
  CHECK(report["effects"][2]["name"] == "track.separation_m");
  CHECK(report["effects"][2]["parameters"]["separation_m"]["value"] == 0.5);
}

TEST_CASE("A robot.toml reads as the robot with what was named, and says what it does not contain") {
  const RobotFile file = robot_file(made_diagnosis());
  CHECK(file.name == "robot.toml");
  CHECK(file.fault == "");
  const physics::RobotDescription robot = robot_in(file.text);
  CHECK(robot.effects.drive_lag_s == 0.0513);
  CHECK(robot.effects == [] {
    physics::Effects effects = physics::load_robot("kenaf").effects;
    effects.drive_lag_s = 0.0513;
    return effects;
  }());
  CHECK_THAT(file.text, Contains("drive_lag lag_s = 0.0513 s (95 % interval 0.0498 to 0.0528)") &&
                            Contains("It does not contain:") &&
                            Contains("the cause of the gap from drive to body: no effect is named") &&
                            Contains("from command to drive: 15 % of the gap remains; yaw rate: measured 0.80"));
  // the description's own text is still there
  const std::string kenaf = test::read_file(description::find_data_file("robots", "kenaf", ".toml"));
  CHECK_THAT(file.text, Contains(kenaf.substr(0, 200)));
}

TEST_CASE("A number of the description is written in its place") {
  Diagnosis d = made_diagnosis_of_one_stage();
  d.stages[0].decision.effects = {made_effect(track_separation, {0.5, 0.49, 0.51}, 0.8)};
  const physics::RobotDescription robot = robot_in(robot_file(d).text);
  CHECK(robot.track.front().p_BT_m.y() == 0.25);
}

TEST_CASE("A robot.toml is written whatever the description has already, and its comments hold no hostile bytes") {
  Diagnosis d = made_diagnosis();
  d.stages[0].left_over[0].words = "run \"a\nb\xff\": [effects.drive_lag]\nlag_s = 9";
  const TemporaryFolder folder;
  const std::string kenaf = test::read_file(description::find_data_file("robots", "kenaf", ".toml"));
  for (const auto& [has, delay_s] : {std::pair{"", 0.0},
                                     {"\n[effects.command_delay]\ndelay_s = 0.05\n", 0.05},
                                     {"\n[effects.drive_lag]\nlag_s = 0.2\n", 0.0}}) {
    test::write_file(folder / "my.toml", kenaf + has);
    d.observations.robot_name = folder / "my.toml";
    const physics::Effects effects = robot_in(robot_file(d).text).effects;
    CHECK(effects.drive_lag_s == 0.0513);
    CHECK(effects.command_delay_s == delay_s);
  }
  // a table in one line, to which none can be added from below; keys without a table come first in a file
  test::write_file(folder / "my.toml", "effects = { command_delay = { delay_s = 0.05 } }\n" + kenaf);
  const physics::Effects effects = robot_in(robot_file(d).text).effects;
  CHECK(effects.drive_lag_s == 0.0513);
  CHECK(effects.command_delay_s == 0.05);
}

TEST_CASE("Where nothing is named the best models are a candidate, and where nothing was fitted there is none") {
  const RobotFile candidate = robot_file(made_unknown());
  CHECK(candidate.name == "robot.candidate.toml");
  CHECK_THAT(candidate.text, Catch::StartsWith("# A CANDIDATE: ") && Contains("com_forward"));
  CHECK_FALSE(robot_in(candidate.text).effects == physics::load_robot("kenaf").effects);
  for (const Diagnosis& d : {made_without_gap(), made_unknown_without_model()}) CHECK(robot_file(d).name == "");
}

TEST_CASE("Values that together make no robot leave the reports without one, which say why") {
  Diagnosis d = made_diagnosis_of_one_stage();
  d.stages[0].decision.effects = {made_effect(track_separation, {-3, -3, -3}, 0.8)};
  const RobotFile file = robot_file(d);
  CHECK(file.name == "");
  CHECK_FALSE(file.fault.empty());
  CHECK_THAT(diagnosis_text(d), Contains("No corrected robot: "));
  const TemporaryFolder folder;
  write_diagnosis(undrawn(d), folder.path());
  CHECK(std::filesystem::exists(folder / "report.json"));
  CHECK_FALSE(std::filesystem::exists(folder / "robot.toml"));
}

TEST_CASE("A robot's file of an earlier diagnosis goes where this one does not write it") {
  const TemporaryFolder folder;
  const auto files = [&](const Diagnosis& d) {
    write_diagnosis(undrawn(d), folder.path());
    return std::pair{std::filesystem::exists(folder / "robot.toml"),
                     std::filesystem::exists(folder / "robot.candidate.toml")};
  };
  CHECK(files(made_diagnosis()) == std::pair{true, false});
  CHECK(files(made_unknown()) == std::pair{false, true});
  CHECK(files(made_ambiguous()) == std::pair{true, false});
  CHECK(files(made_without_gap()) == std::pair{false, false});
}

TEST_CASE("Curves of an earlier diagnosis go with its reports, another program's file of that name stays") {
  const TemporaryFolder folder;
  test::write_file(folder / kCurvesFile, "another program's");
  write_diagnosis(undrawn(made_diagnosis()), folder.path());
  CHECK(std::filesystem::exists(folder / kCurvesFile));
  write_diagnosis(undrawn(made_unknown()), folder.path());
  CHECK_FALSE(std::filesystem::exists(folder / kCurvesFile));
}

TEST_CASE("A diagnosis that was interrupted names nothing, and leaves a robot.toml of one before as it is") {
  const TemporaryFolder folder;
  test::write_file(folder / "robot.toml", "mine");
  test::write_file(folder / "robot.candidate.toml", "mine");
  Diagnosis d = undrawn(made_diagnosis());
  d.interrupted = "drive to body";
  d.verdict = Verdict::unknown;
  d.largest_stage.reset();
  d.stages.pop_back();
  write_diagnosis(d, folder.path());
  CHECK(test::read_file(folder / "robot.toml") == "mine");
  CHECK(test::read_file(folder / "robot.candidate.toml") == "mine");
  json report = json::parse(test::read_file(folder / "report.json"));
  CHECK(report["interrupted"] == "drive to body");
  CHECK(report["named"].empty());
  CHECK(report["stages"][0]["named"].empty());
  CHECK_THAT(diagnosis_text(d), Catch::StartsWith("UNFINISHED: interrupted while drive to body"));

  d = {};
  d.interrupted = "simulating the nominal robot";
  write_diagnosis(d, folder.path());
  report = json::parse(test::read_file(folder / "report.json"));
  CHECK(report["stages"].empty());
  CHECK(report["gap"]["before"].is_null());
  CHECK(report["gap"]["shrink"].is_null());
  CHECK(report["gap"]["shrink_by_manoeuvre"].is_null());
  CHECK(report["gap"]["heldout_runs"].empty());
  CHECK(report["where"]["stage"].is_null());
  CHECK_THAT(diagnosis_text(d), Contains("noise not measured yet"));
  d.interrupted.clear();
  write_diagnosis(d, folder.path());
  CHECK_FALSE(std::filesystem::exists(folder / "robot.toml"));
  CHECK_FALSE(std::filesystem::exists(folder / "robot.candidate.toml"));
}

TEST_CASE("A diagnosis that was interrupted leaves the reports of a complete one, until there is another one") {
  const TemporaryFolder folder;
  Diagnosis d;
  d.interrupted = "command to drive";
  CHECK(write_diagnosis(d, folder.path()) == folder / "report.html");  // there is no other one
  d.interrupted.clear();
  CHECK(write_diagnosis(d, folder.path()) == folder / "report.html");
  const std::string complete = test::read_file(folder / "report.json");
  d.interrupted = "command to drive";
  CHECK(write_diagnosis(d, folder.path()) == folder / "report.partial.html");
  CHECK(test::read_file(folder / "report.json") == complete);
  CHECK(json::parse(test::read_file(folder / "report.partial.json")).contains("interrupted"));
  d.interrupted.clear();
  write_diagnosis(d, folder.path());
  CHECK_FALSE(std::filesystem::exists(folder / "report.partial.html"));
  CHECK_FALSE(std::filesystem::exists(folder / "report.partial.json"));
}

TEST_CASE("Of one run nothing is held out, and the report says so") {
  Diagnosis d = made_diagnosis();
  d.observations.runs.resize(1);
  d.repeats = {{0}};
  for (StageDiagnosis& stage : d.stages) stage.where.phases.clear();
  const json gap = json_of(d)["gap"];
  CHECK(gap["heldout_runs"].empty());
  CHECK(gap["measured_on"] == "the fitted run, the only one");
}

TEST_CASE("The text has every value and doubt in words, on one screen") {
  Diagnosis d = made_diagnosis();
  d.stages[1].decision.effects[0].doubts = {Doubt::end_of_range, Doubt::disagreement, Doubt::not_held_out,
                                            Doubt::little_explained};
  d.stages[1].decision.effects[0].share.of_kind = 0.03;
  d.stages[1].decision.effects[0].share_by_manoeuvre.of_kind = 0.05;
  d.stages[1].decision.effects[0].share.model_of_kind = 0.31;
  std::string text = diagnosis_text(d);
  CHECK(std::ranges::count(text, '\n') <= 40);
  for (std::size_t at; (at = text.find("\n")) != text.npos;) text.replace(at, 1, " ");
  for (std::size_t at; (at = text.find("  ")) != text.npos;) text.replace(at, 2, " ");
  CHECK_THAT(text,
             Catch::StartsWith("NAMED: drive_lag explains 85 % of the gap from command to drive; no effect is named "
                               "for the gap from drive to body "));
  CHECK_THAT(text, Contains("drive_lag lag_s = 0.0513 s (95 % interval 0.0498 to 0.0528), nominal 0; explains 85 %"));
  CHECK_THAT(text, Contains("8.25 times the noise before, 1.50 after on runs held out; noise alone: 1.25"));
  CHECK_THAT(text, Contains("15 % of the gap remains; yaw rate: measured 0.80 of the simulated, in every run; look at "
                            "track.separation_m or friction_across"));
  CHECK_THAT(text, Contains("not named: its value is at the end of its range (") &&
                       Contains("the values fitted to single manoeuvres differ by more than it") &&
                       Contains("it explains only 3 % of the gap in track speed on runs held out") &&
                       Contains("all effects together explain only 31 % of the gap in track speed on runs held out"));
}
