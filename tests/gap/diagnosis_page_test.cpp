// The page of a diagnosis, made by hand without any simulation: two manoeuvres, "drive" twice and one whose name needs
// escaping; the simulated robot is 0.1 m ahead in x.
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "description/data_files.hpp"
#include "gap/diagnose/channels.hpp"
#include "gap/diagnose/page/sections.hpp"
#include "gap/diagnose/page/words.hpp"
#include "gap/diagnose/report.hpp"
#include "physics/robot_description.hpp"
#include "tests/gap/well_formed.hpp"
#include "tests/runs/temporary_folder.hpp"

using namespace kenaf;
using namespace kenaf::gap;
using Catch::Contains;
using kenaf::test::fault_of_xml;

namespace {

constexpr double kSigma = 0.01;

std::size_t channel(std::string_view column) {
  for (std::size_t c = 0; c < diagnosis_channels().size(); ++c)
    if (diagnosis_channels()[c].column == column) return c;
  throw std::invalid_argument("no such channel");
}

// 2 s along x, climbing, with both tracks' speed.
runs::Run run_ahead_by(double ahead_m) {
  runs::Run run{{"t_s", "x_m", "y_m", "z_m", "track_left_mps", "track_right_mps"}, std::vector<std::vector<double>>(6)};
  for (int i = 0; i <= 20; ++i) {
    const double t_s = 0.1 * i, row[] = {t_s, 0.5 * t_s + ahead_m, 0, 0.1 + 0.1 * t_s, 0.5, 0.5};
    for (std::size_t c = 0; c < 6; ++c) run.values[c].push_back(row[c]);
  }
  return run;
}

EffectCurve curve_of(std::string_view name) {
  const physics::EffectInfo* effect = physics::find_effect(name);
  REQUIRE(effect != nullptr);
  return {effect, &effect->parameters.front(), {{effect->parameters.front().neutral, -1, true}}, 5};
}

Diagnosis two_manoeuvres() {
  Diagnosis d;
  d.options.seed = 4711;
  d.observations.robot_name = "kenaf";
  d.observations.dataset.description = "Logs of <Monday> & Tuesday";
  d.observations.warnings = {"run-007.csv: \"late\" <clock>"};
  d.repeats = {{0, 1}, {2}};
  for (const auto& [file, manoeuvre] :
       {std::pair{"run-000.csv", "drive"}, {"run-001.csv", "drive"}, {"run-002.csv", "up & <over>"}})
    d.observations.runs.push_back({.file = file,
                                   .manoeuvre = manoeuvre,
                                   .world = 0,
                                   .run = run_ahead_by(0),
                                   .replay = {},
                                   .measured = {},
                                   .resting_rows = 0});
  d.nominal_floor.from_repeats = true;
  d.nominal_floor.sigma.assign(diagnosis_channels().size(), kSigma);
  for (const Observation& observed : d.observations.runs) {
    d.features.emplace_back(observed.run, d.options.span_s);
    const FeatureMap& map = d.features.back();
    d.nominal.push_back(map.of(run_ahead_by(0.1)));
    const Eigen::VectorXd sigma = Eigen::VectorXd::Constant(map.measured().size(), kSigma);
    d.nominal_floor.sigma_of_bin.push_back(sigma);
    d.nominal_floor.whiteners.emplace_back(sigma, Eigen::MatrixXd::Zero(sigma.size(), 1));
  }
  d.where = {{{channel("x_m"), 0.1, kSigma, 0.9}, {channel("z_m"), 0.02, kSigma, 0.1}},
             {{"up & <over>", "climb", 0.5, 2, 0.6, 0, 0.7, 1}, {"drive", "cruise", 0, 2, 0.5, 0, 0.3, 0}},
             200};
  d.where_left = {d.where.channels, d.where.phases, 20};
  d.stages = {{Passage::command_to_drive, 1, 0.9, 30},
              {Passage::drive_to_body, 9, 77.7, 60},
              {Passage::body_to_sensor, 0, 0, 0}};
  d.curves.curves = {curve_of("drive_lag"), curve_of("com_forward"), curve_of("ground_slope")};
  d.decision.verdict = Verdict::named;
  d.decision.best.places = {{0, 0.0513}};
  d.decision.rivals = {{0}};
  d.decision.p_gap = 1e-9;
  d.decision.p_left = 0.37;
  d.gap = {8.25, 1.5, 1.25, {0.964, 0.91, 0.99}, {0.87, 0.8, 0.93}, {}, {}};
  d.gap.before_si.assign(diagnosis_channels().size(), std::nan(""));
  d.gap.after_si = d.gap.before_si;
  d.gap.before_si[channel("x_m")] = 0.1;
  d.gap.after_si[channel("x_m")] = 0.0123;
  d.best = {{0, {0.0513, 0.0498, 0.0528}, 0.97, {0.964, 0.91, 0.99}, 1e-9, false}};
  d.ranking = {d.best.front(),
               {1, {-0.021, -0.03, -0.01}, 0.2, {0.15, 0.1, 0.2}, 0.04, false},
               {2, {0.5, 0.2, 0.5}, 0.1, {0.05, -0.1, 0.1}, 0.6, true}};
  d.isolability.curves = {0, 1, 2};
  d.isolability.angle_deg = (Eigen::Matrix3d() << 0, 80, 75, 80, 0, 4.2, 75, 4.2, 0).finished();
  d.roll_outs = 321;
  return d;
}

std::vector<Overlay> overlays_of(const Diagnosis& d) {
  std::vector<Overlay> overlays;
  for (const std::size_t group : shown_groups(d))
    overlays.push_back({group, d.repeats[group].front(), {}, {}, run_ahead_by(0.1), run_ahead_by(0.01)});
  choose_channels(d, overlays);
  return overlays;
}

std::string page_of(const Diagnosis& d) {
  std::string page = diagnosis_page(d, overlays_of(d));
  CHECK(fault_of_xml(page) == "");
  for (const char* section : {"overlay", "residuals", "where", "ranking", "confusability", "next", "used", "method"})
    CHECK_THAT(page, Contains("<h2 id=\"" + std::string(section) + "\">"));
  CHECK_THAT(page, !Contains("nan") && !Contains("inf)") && !Contains("-0 %"));
  return page;
}

}  // namespace

TEST_CASE("A page has the verdict, every section, and every number of the diagnosis") {
  const std::string page = page_of(two_manoeuvres());
  CHECK_THAT(page, Contains("<h1>The gap is explained by drive_lag</h1>") && Contains("p &lt; 0.0001") &&
                       Contains("robot.toml"));
  CHECK_THAT(page, Contains("lag_s = 0.0513 s (0.0498 to 0.0528)"));
  // gap before, after, floor; shrink by repeats and by manoeuvres
  CHECK_THAT(page, Contains(">8.25<") && Contains(">1.50<") && Contains("floor 1.25") && Contains(">96 %<") &&
                       Contains(">87 %<"));
  // ranking: name, value, shrink, p
  for (const char* name : {"drive_lag", "com_forward", "ground_slope"}) CHECK_THAT(page, Contains(name));
  CHECK_THAT(page,
             Contains("-0.021 m (-0.03 to -0.01)") && Contains("15 % (10 to 20 %)") && Contains("5 % (-10 to 10 %)"));
  CHECK_THAT(page, Contains("end of range"));
  // residuals in units and in noise: 0.1 m is 10 times the noise of 0.01 m
  CHECK_THAT(page, Contains("<td>0.1</td><td>0.0123</td><td>0.01</td><td>10</td><td>1.23</td><td>90 %</td>"));
  // of the gap of 200 a tenth is left: 70 % of it in the climb
  CHECK_THAT(page, Contains("<td>70 %</td><td>7 %</td>"));
  CHECK_THAT(page,
             Contains("drive to body") && Contains("77.7") && Contains("Not measured by these runs: body to sensor"));
  CHECK_THAT(page, Contains("ground_slope and com_forward (4.2 degrees)") && !Contains("(80.0 degrees)"));
  CHECK_THAT(page, Contains("Seed of resampling: 4711") && Contains("Simulated runs: 321"));
}

TEST_CASE("A page needs nothing but itself, and its colours follow light, dark and paper") {
  const std::string page = page_of(two_manoeuvres());
  CHECK_THAT(page, !Contains("<script") && !Contains("<link") && !Contains("href=\"http") && !Contains("src=") &&
                       !Contains("@import") && !Contains("url("));
  CHECK_THAT(page, Contains("prefers-color-scheme: dark") && Contains("@media print"));
}

TEST_CASE("Names and warnings are shown as they are, whatever they hold") {
  Diagnosis d = two_manoeuvres();
  d.observations.warnings.push_back(
      "a\x01"
      "b");  // may stand in no XML
  const std::string page = page_of(d);
  CHECK_THAT(page, Contains("up &amp; &lt;over&gt;") && Contains("run-007.csv: &quot;late&quot; &lt;clock&gt;") &&
                       Contains("Logs of &lt;Monday&gt; &amp; Tuesday"));
  CHECK_THAT(page, !Contains("<over>") && !Contains("<clock>") && !Contains("<Monday>"));
}

TEST_CASE("A robot with effects has the one that was found among them, however its file writes them") {
  const Diagnosis d = two_manoeuvres();  // found drive_lag of 0.0513 s
  const test::TemporaryFolder folder;
  std::string kenaf = test::read_file(find_data_file("robots", "kenaf", ".toml"));
  for (const auto& [has, lag_s, delay_s] : {std::tuple{"", 0.0513, 0.0},
                                            {"\n[effects.command_delay]\ndelay_s = 0.05\n", 0.0513, 0.05},
                                            {"\n[effects.drive_lag]\nlag_s = 0.2\n", 0.0513, 0.0}}) {
    test::write_file(folder / "my.toml", kenaf + has);
    test::write_file(folder / "corrected.toml", corrected_robot_toml(d, folder / "my.toml"));
    const physics::Effects effects = physics::load_robot(folder / "corrected.toml").effects;
    CHECK(effects.drive_lag_s == lag_s);
    CHECK(effects.command_delay_s == delay_s);
  }
  // a table in one line, to which none can be added from below; keys without a table come first in a file
  test::write_file(folder / "my.toml", "effects = { command_delay = { delay_s = 0.05 } }\n" + kenaf);
  test::write_file(folder / "corrected.toml", corrected_robot_toml(d, folder / "my.toml"));
  const physics::Effects effects = physics::load_robot(folder / "corrected.toml").effects;
  CHECK(effects.drive_lag_s == 0.0513);
  CHECK(effects.command_delay_s == 0.05);
}

TEST_CASE("A value that is a whole number is written as a float, and the description keeps its comments") {
  Diagnosis d = two_manoeuvres();
  d.decision.best.places = {{0, 1}};
  CHECK_THAT(corrected_robot_toml(d, "kenaf"), Contains("# found by a diagnosis of runs\nlag_s = 1.0\n"));
}

TEST_CASE("Each verdict says what it means and what to do next") {
  Diagnosis d = two_manoeuvres();
  d.decision.verdict = Verdict::ambiguous;
  d.decision.best.places = {{1, -0.02}};
  d.decision.rivals = {{1, 2}};
  d.best = {d.ranking[1]};
  d.next = {{"turn-in-place", {1, 2}, 7.4}, {"straight", {1, 2}, 0.3}};
  CHECK_THAT(page_of(d), Contains("one of com_forward or ground_slope, which these runs cannot tell apart</h1>") &&
                             Contains("Drive &quot;turn-in-place&quot;") && Contains(">7.4<") &&
                             Contains(">straight<"));

  d.decision.verdict = Verdict::unknown;
  CHECK_THAT(page_of(d),
             Contains("<h1>A gap that the effects of the catalogue do not explain, alone or together</h1>") &&
                 Contains("No robot.toml was written"));

  d.decision = {};
  d.best.clear();
  d.next.clear();
  d.gap.after = d.gap.before;
  CHECK_THAT(page_of(d), Contains("<h1>No gap: ") && Contains("comes by chance alone with p = 1"));
}

TEST_CASE("A fit that ended at the end of its range is a warning under the headline") {
  Diagnosis d = two_manoeuvres();
  CHECK_THAT(page_of(d), !Contains("ended at the end of its range"));
  d.best.front().at_bound = true;
  CHECK_THAT(page_of(d), Contains("The fit of drive_lag lag_s ended at the end of its range (0 to 3 s)"));
}

TEST_CASE("Two effects: both are named, with what each explains beyond the other") {
  Diagnosis d = two_manoeuvres();
  d.decision.best.places = {{0, 0.0513}, {1, -0.02}};
  d.decision.rivals = {{0}, {1}};
  d.best.push_back(d.ranking[1]);
  CHECK_THAT(page_of(d), Contains("The gap is explained by drive_lag and com_forward</h1>") &&
                             Contains("Together they take 96 % (91 to 99 %) off runs held out"));
}

TEST_CASE("A diagnosis that was interrupted still has a page, which says so before anything else") {
  Diagnosis d;
  d.interrupted = "simulating the nominal robot";
  const std::string early = page_of(d);
  CHECK_THAT(early, Contains("<h1>Unfinished: interrupted while simulating the nominal robot</h1>") &&
                        Contains("there is no verdict") && !Contains("No gap"));

  d = two_manoeuvres();
  d.interrupted = "comparing effects";
  d.decision = {};
  d.best.clear();
  d.ranking.clear();
  d.isolability = {};
  d.gap = {};
  const std::string late = page_of(d);
  CHECK_THAT(late, Contains("Unfinished") && Contains("Effects were not compared") && Contains("climb"));
}

TEST_CASE("A diagnosis that was interrupted names nothing, and leaves a robot.toml of one before as it is") {
  const test::TemporaryFolder folder;
  test::write_file(folder / "robot.toml", "mine");
  Diagnosis d;
  d.interrupted = "holding runs out";
  d.decision.verdict = Verdict::unknown;
  write_diagnosis(d, folder.path());
  CHECK(test::read_file(folder / "robot.toml") == "mine");
  const auto report = nlohmann::json::parse(test::read_file(folder / "report.json"));
  CHECK(report["interrupted"] == "holding runs out");
  CHECK(report["gap"]["before"].is_null());
  CHECK(report["gap"]["shrink"].is_null());
  CHECK(report["gap"]["shrink_by_manoeuvre"].is_null());
  CHECK(report["gap"]["heldout_runs"].empty());
  CHECK(report["where"]["stage"].is_null());
  CHECK_THAT(diagnosis_text(d), Contains("noise not measured yet") && !Contains("Where:"));
  d.interrupted.clear();
  write_diagnosis(d, folder.path());
  CHECK_FALSE(std::filesystem::exists(folder / "robot.toml"));
}

TEST_CASE("A diagnosis that was interrupted leaves the reports of a complete one, until there is another one") {
  const test::TemporaryFolder folder;
  Diagnosis d;
  d.interrupted = "comparing effects";
  CHECK(write_diagnosis(d, folder.path()) == folder / "report.html");  // there is no other one
  d.interrupted.clear();
  CHECK(write_diagnosis(d, folder.path()) == folder / "report.html");
  const std::string complete = test::read_file(folder / "report.json");
  d.interrupted = "comparing effects";
  CHECK(write_diagnosis(d, folder.path()) == folder / "report.partial.html");
  CHECK(test::read_file(folder / "report.json") == complete);
  CHECK(nlohmann::json::parse(test::read_file(folder / "report.partial.json")).contains("interrupted"));
  d.interrupted.clear();
  write_diagnosis(d, folder.path());
  CHECK_FALSE(std::filesystem::exists(folder / "report.partial.html"));
  CHECK_FALSE(std::filesystem::exists(folder / "report.partial.json"));
}

TEST_CASE("Of one run nothing is held out, and the report says so") {
  Diagnosis d = two_manoeuvres();
  CHECK(nlohmann::json::parse(diagnosis_json(d))["gap"]["heldout_runs"].size() == 3);
  d.observations.runs.resize(1);
  d.repeats = {{0}};
  d.where.phases.clear();
  const auto gap = nlohmann::json::parse(diagnosis_json(d))["gap"];
  CHECK(gap["heldout_runs"].empty());
  CHECK(gap["measured_on"] == "the run fitted to, as there is no other");
}

TEST_CASE("Where the search for the next manoeuvre was interrupted, the verdict stands") {
  Diagnosis d = two_manoeuvres();
  d.next_interrupted = true;
  CHECK_THAT(page_of(d), Contains("The gap is explained by drive_lag") && Contains("It was not worked out before"));
  CHECK_THAT(diagnosis_text(d), Catch::StartsWith("NAMED: drive_lag"));
}

TEST_CASE("Runs without repeats and without any visible effect have a page") {
  Diagnosis d = two_manoeuvres();
  d.nominal_floor.from_repeats = false;
  d.decision = {};
  d.best.clear();
  d.ranking.clear();
  d.isolability = {};
  CHECK_THAT(page_of(d), Contains("none repeats another") && Contains("show no effect of the catalogue"));
}

TEST_CASE("Where no next manoeuvre was asked for, the page says that, not that none is needed") {
  Diagnosis d = two_manoeuvres();
  d.next.clear();
  d.options.propose_next = false;
  CHECK_THAT(page_of(d), Contains("It was not asked for.") && !Contains("Nothing has to be told apart"));
}

TEST_CASE("Look-alikes become neighbours") {
  // 0 with 2, and 1 with 3; the pairs have little in common
  Eigen::Matrix4d angle_deg;
  angle_deg << 0, 80, 5, 85, 80, 0, 70, 8, 5, 70, 0, 90, 85, 8, 90, 0;
  const std::vector<std::size_t> order = look_alikes_together(angle_deg);
  REQUIRE(order.size() == 4);
  const auto place = [&](std::size_t i) { return std::ranges::find(order, i) - order.begin(); };
  CHECK(std::abs(place(0) - place(2)) == 1);
  CHECK(std::abs(place(1) - place(3)) == 1);
  CHECK(std::abs(place(2) - place(1)) == 1);  // of the four ends these two are most alike
  CHECK(look_alikes_together(Eigen::MatrixXd(0, 0)).empty());
}

TEST_CASE("An overlay shows the channels with most of the gap, of left and right one") {
  Diagnosis d = two_manoeuvres();
  for (std::size_t r = 0; r < d.nominal.size(); ++r)
    for (std::size_t b = 0; b < d.features[r].bins().size(); ++b) {
      const std::size_t c = d.features[r].bins()[b].channel;
      if (c == channel("track_left_mps")) d.nominal[r][static_cast<Eigen::Index>(b)] -= 0.30;
      if (c == channel("track_right_mps")) d.nominal[r][static_cast<Eigen::Index>(b)] -= 0.29;
    }
  const std::vector<Overlay> overlays = overlays_of(d);
  REQUIRE(overlays.size() == 2);
  for (const Overlay& overlay : overlays) {
    // 30 and 10 noises: shares of 0.9, and of 0.1 without what the right track has
    CHECK(overlay.channels == std::vector<std::size_t>{channel("track_left_mps"), channel("x_m")});
    CHECK(overlay.shares[0] > overlay.shares[1]);
  }
  // of the whole gap: both manoeuvres have about half of it, and what is not shown the rest
  const double sum = overlays[0].shares[0] + overlays[0].shares[1] + overlays[1].shares[0] + overlays[1].shares[1];
  CHECK(sum < 1);
  CHECK(overlays[0].shares[0] < 0.5);
}

TEST_CASE("Of many manoeuvres those with most of the gap are drawn, in the order of the dataset") {
  Diagnosis d;
  for (std::size_t g = 0; g < 30; ++g) {
    d.repeats.push_back({g});
    d.where.phases.push_back({"m", "cruise", 0, 1, 0, 0, g == 3 || g == 20 ? 0.3 : 0.01, g});
  }
  const std::vector<std::size_t> shown = shown_groups(d);
  CHECK(shown.size() < 12);
  CHECK(std::ranges::is_sorted(shown));
  CHECK(std::ranges::count(shown, 3u) == 1);
  CHECK(std::ranges::count(shown, 20u) == 1);
}

TEST_CASE("A heading that passes half a turn is one line, and a long pause breaks it") {
  const double pi = std::numbers::pi;
  const runs::Run run{{"t_s", "yaw_rad"},
                      {{0, 0.1, 0.2, 5, 5.1}, {pi - 0.1, std::nan(""), -pi + 0.1, -pi + 0.2, -pi + 0.3}}};
  const auto points = over_time(run, channel("yaw_rad"));
  REQUIRE(points.size() == 5);
  CHECK(points[1].y() == Approx(pi + 0.1));
  CHECK(std::isnan(points[2].y()));  // between 0.2 s and 5 s
  CHECK(points[4].y() == Approx(pi + 0.3));
}

TEST_CASE("Manoeuvres of one name are told apart by their files") {
  Diagnosis d = two_manoeuvres();
  CHECK(group_title(d, 0) == "drive");
  d.observations.runs[2].manoeuvre = "drive";
  CHECK(group_title(d, 0) == "drive (run-000.csv)");
  CHECK(group_title(d, 1) == "drive (run-002.csv)");
  d.observations.runs[2].manoeuvre = "";
  CHECK(group_title(d, 1) == "run-002.csv");
}
