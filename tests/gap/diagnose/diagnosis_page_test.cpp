// The page of a diagnosis that was made by hand.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "gap/diagnose/page/sections.hpp"
#include "gap/diagnose/report_words.hpp"
#include "tests/gap/diagnose/made_diagnosis.hpp"
#include "tests/gap/well_formed.hpp"

using namespace kenaf;
using namespace kenaf::gap;
using namespace kenaf::gap::candidates;
using namespace kenaf::gap::diagnose;
using namespace kenaf::test;
using Catch::Contains;

namespace {

std::vector<Overlay> overlays_of(const Diagnosis& d) {
  std::vector<Overlay> overlays;
  for (const std::size_t group : shown_groups(d))
    overlays.push_back({group, d.repeats[group].front(), {}, {}, run_ahead_by(0.1, 0.05), run_ahead_by(0.01)});
  choose_channels(d, overlays);
  return overlays;
}

std::string page_of(const Diagnosis& d) {
  std::string page = diagnosis_page(d, overlays_of(d));
  CHECK(fault_of_xml(page) == "");
  for (const char* section : {"where", "overlay", "next", "used", "method"})
    CHECK_THAT(page, Contains("<h2 id=\"" + std::string(section) + "\">"));
  for (const StageDiagnosis& stage : d.stages)
    CHECK_THAT(page, Contains("<h2 id=\"" + stage_id(stage.passage) + "\">"));
  CHECK_THAT(page, !Contains("nan") && !Contains("inf)") && !Contains("-0 %"));
  return page;
}

// Its first screen, before anything about one stage.
std::string answers_of(const Diagnosis& d) {
  const std::string page = page_of(d);
  return page.substr(0, page.find("<nav>"));
}

}  // namespace

TEST_CASE("The first screen says where, which, how much, what is left and what next") {
  const std::string answers = answers_of(made_diagnosis());
  CHECK_THAT(answers,
             Contains("<h1>drive_lag explains 85 % of the gap from command to drive; no effect is named for the gap "
                      "from drive to body</h1>"));
  for (const char* question : {"Where is the gap?", "Which effects?", "How much?", "What is left?", "What next?"})
    CHECK_THAT(answers, Contains("<dt>" + std::string(question) + "</dt>"));
  // squared beyond noise: 8.25^2 - 1.25^2 = 66.5 of 66.5 + 24
  CHECK_THAT(answers,
             Contains("73 % of it is <b>from command to drive</b>") && Contains("Most of that is in track_left_mps."));
  CHECK_THAT(answers, Contains("<b>drive_lag</b> lag_s = 0.0513 s (95 % interval 0.0498 to 0.0528), nominal 0"));
  CHECK_THAT(answers,
             Contains("Not named: com_forward (the values fitted to single manoeuvres differ by more than it)."));
  CHECK_THAT(answers, Contains("8.25 times the noise before, 1.50 after on runs held out; noise alone: 1.25") &&
                          Contains("<b>85 % (81 to 88 %)</b> of the squared gap is explained") &&
                          Contains("track_left_mps: 0.05 m/s rms before, 0.0123 after"));
  CHECK_THAT(answers,
             Contains("15 % of the gap remains. Yaw rate: measured 0.80 of the simulated, in every run: look at "
                      "track.separation_m or friction_across"));
  CHECK_THAT(answers,
             Contains("Use <b>robot.toml</b>") && Contains("a comment at its top lists what it does not contain"));
}

TEST_CASE("The first screen says where the gap is worst, and which runs the correction worsens") {
  Diagnosis d = made_diagnosis();
  const std::string better = answers_of(d);
  // 0.1 m ahead with 0.01 m of noise, and both tracks 0.05 m/s too fast, of five channels
  CHECK_THAT(better,
             Contains("<dt>Where is it worst?</dt>") && Contains("the nominal simulation is <b>5.5 \u00d7 noise</b>") &&
                 Contains("It is most off in x_m: measured ") && Contains(" difference -0.100 m (10 \u00d7 noise)"));
  CHECK_THAT(better, !Contains("The correction worsens"));

  // corrected by twice as much, the other way
  std::vector<Overlay> overlays = overlays_of(d);
  overlays[1].corrected = run_ahead_by(-0.2, 0.05);
  const std::string page = diagnosis_page(d, overlays);
  CHECK(fault_of_xml(page) == "");
  CHECK_THAT(page.substr(0, page.find("<nav>")),
             Contains("The correction worsens run-002.csv (up &amp; &lt;over&gt;): over the whole run the corrected "
                      "simulation is ") &&
                 Contains("; most in x_m, ") && !Contains("worsens run-000.csv"));
  CHECK_THAT(page.substr(page.find("<h3>Warnings</h3>")), Contains("The correction worsens run-002.csv"));

  // without a gap nothing is worst
  CHECK_THAT(answers_of(made_without_gap()), !Contains("Where is it worst?"));
}

TEST_CASE("A page has every number of every stage") {
  const std::string page = page_of(made_diagnosis());
  // gap before, after, noise; shrink by repeats and by manoeuvres
  CHECK_THAT(page, Contains(">8.25<") && Contains(">1.5<") && Contains("noise 1.25") && Contains(">96 %<") &&
                       Contains(">87 %<"));
  CHECK_THAT(page, Contains("<td>0.0513 s (0.0498 to 0.0528)</td><td>0</td><td>0</td><td>85 % (83 %)</td>"));
  CHECK_THAT(page, Contains("no: the values fitted to single manoeuvres differ by more than it"));
  // ranking, residuals in units and in noise: 0.05 m/s is 5 times the noise of 0.01 m/s
  CHECK_THAT(page, Contains("com_forward") && Contains("ground_slope") && Contains("track.separation_m"));
  CHECK_THAT(page, Contains("<td>0.05</td><td>0.0123</td><td>0.01</td><td>5</td><td>1.23</td><td>90 %</td>"));
  // of the gap of 200 a tenth is left: 70 % of it in the climb
  CHECK_THAT(page, Contains("<td>70 %</td><td>7 %</td>"));
  CHECK_THAT(page, Contains("com_forward and ground_slope (4.2 degrees)") && !Contains("(80.0 degrees)"));
  CHECK_THAT(page, Contains("Yaw rate over turn rate") || Contains("yaw rate over turn rate"));
  CHECK_THAT(page, Contains("Seed of resampling: 4711") && Contains("Simulated runs: 321"));
}

TEST_CASE("A stage without a gap has no bar, also where it is the only one") {
  Diagnosis d = made_diagnosis();
  for (StageDiagnosis& stage : d.stages) stage.decision.verdict = Verdict::none;
  d.verdict = Verdict::none;
  CHECK_THAT(answers_of(d), !Contains("class=\"share\"") && Contains("no gap"));
}

TEST_CASE("A named effect is told from what looks like it, unless that is a rival") {
  Diagnosis d = made_diagnosis();
  StageDiagnosis& stage = d.stages[0];
  REQUIRE(stage.decision.effects.size() == 1);
  stage.isolability.candidates = {drive_lag, track_separation};
  stage.isolability.angle_deg = (Eigen::Matrix2d() << 0, 5, 5, 0).finished();
  CHECK_THAT(page_of(d), Contains("drive_lag and track.separation_m (5.0 degrees; told apart here)"));
  stage.decision.effects[0].rivals = {drive_lag, track_separation};
  CHECK_THAT(page_of(d), Contains("drive_lag and track.separation_m (5.0 degrees)<"));
}

TEST_CASE("The table of look-alikes has the effects of the verdict and their rivals on top, the others folded") {
  const auto table_of = [](const Diagnosis& d) {
    const std::string page = page_of(d), begin = "<div class=\"angles";
    return page.substr(page.find(begin), page.find("</table>", page.find(begin)) - page.find(begin));
  };
  const auto row = [](const std::string& name) { return Contains("<tr><th scope=\"row\">" + name + "</th>"); };
  const auto parts = [&](const std::string& table) {
    const std::size_t rest = table.find("<tbody class=\"rest\">");
    return std::pair{table.substr(0, rest), table.substr(rest)};
  };
  const auto [named, folded] = parts(table_of(made_diagnosis()));
  CHECK_THAT(named, row("drive_lag") && !row("com_forward") && !row("ground_slope"));
  CHECK_THAT(named, Contains("show the other 2 rows"));
  CHECK_THAT(folded, row("com_forward") && row("ground_slope"));
  CHECK_THAT(folded, Contains("data-deg=\"4.2\">4</td>"));

  const auto [ambiguous, others] = parts(table_of(made_ambiguous()));
  CHECK_THAT(ambiguous, row("com_forward") && row("ground_slope") && !row("drive_lag"));
  CHECK_THAT(others, row("drive_lag"));

  // without a model nothing is on top, and the whole table is folded
  Diagnosis d = made_diagnosis();
  d.stages[0].decision.effects.clear();
  CHECK_THAT(table_of(d), Contains("class=\"angles whole\"") && Contains("show the table of 3 candidates"));
}

TEST_CASE("A page needs nothing but itself, and its colours follow light, dark and paper") {
  const std::string page = page_of(made_diagnosis());
  CHECK_THAT(page, !Contains("<script ") && !Contains("import ") && !Contains("fetch(") && !Contains("<link") &&
                       !Contains("href=\"http") && !Contains("src=") && !Contains("@import") && !Contains("url("));
  CHECK_THAT(page, Contains("prefers-color-scheme: dark") && Contains("@media print"));
}

TEST_CASE("Names, words and warnings are shown as they are, whatever they hold") {
  Diagnosis d = made_diagnosis();
  d.observations.warnings.push_back(
      "a\x01"
      "b");  // may stand in no XML
  for (Candidate& candidate : d.candidates) {
    candidate.name += "<b>&\"";
    candidate.effect = candidate.name;
    candidate.parameter += "<i>";
    candidate.unit = "<u>";
    candidate.summary = "</section>\x02";
  }
  Dependence& left = d.stages[0].left_over[0];
  left.words = "run <b> & more";
  left.look_at = {"<a>", "\"&"};
  left.channel = "<channel>";
  left.on = "<on>";
  const std::string page = page_of(d);
  CHECK_THAT(page, Contains("up &amp; &lt;over&gt;") && Contains("run-007.csv: &quot;late&quot; &lt;clock&gt;") &&
                       Contains("Logs of &lt;Monday&gt; &amp; Tuesday") && Contains("drive_lag&lt;b&gt;&amp;&quot;"));
  CHECK_THAT(page, !Contains("<over>") && !Contains("<clock>") && !Contains("<Monday>") && !Contains("<i>") &&
                       !Contains("<u>") && !Contains("<a>") && !Contains("<on>"));
  Diagnosis ambiguous = made_ambiguous();
  for (Candidate& candidate : ambiguous.candidates) candidate.name += "<b>&";
  CHECK_THAT(page_of(ambiguous), !Contains("com_forward<b>"));
}

TEST_CASE("Each verdict says what it means and what to do next") {
  CHECK_THAT(
      answers_of(made_ambiguous()),
      Contains("<h1>One of com_forward or ground_slope explains 85 % of the gap from command to drive, but these runs "
               "cannot tell which</h1>") &&
          Contains("ground_slope would explain it as well") &&
          Contains("To distinguish com_forward and ground_slope: drive next: turn-in-place (11 s, flat ground)"));
  CHECK_THAT(page_of(made_ambiguous()), Contains(">7.4<") && Contains(">straight<"));

  CHECK_THAT(answers_of(made_unknown()),
             Contains("<h1>There is a gap from drive to body, and no effect is named</h1>") &&
                 Contains("Explain most of the gap alone: com_forward (50 %) and track.separation_m (30 %)") &&
                 Contains("<b>robot.candidate.toml</b>") && Contains("No robot.toml was written"));
  CHECK_THAT(page_of(made_unknown_without_model()), Contains("all of the gap remains") &&
                                                        Contains("No candidate alone gains enough evidence") &&
                                                        !Contains("<b>robot.candidate.toml</b>"));
  CHECK_THAT(page_of(made_without_gap()), Contains("<h1>No gap: ") && Contains("Use the simulator as it is") &&
                                              Contains("Nowhere: no stage has a gap."));

  Diagnosis complete = made_diagnosis_of_one_stage();
  complete.complete = complete.stages[0].decision.complete = true;
  CHECK_THAT(answers_of(complete), Contains("the residual is within noise and spread") &&
                                       Contains("no gap should remain") && !Contains("Yaw rate"));
}

TEST_CASE("Two effects of one stage are both named, with the share that each explains") {
  Diagnosis d = made_diagnosis_of_one_stage();
  d.stages[0].decision.effects.push_back(made_effect(com_forward, {-0.02, -0.03, -0.01}, 0.12));
  CHECK_THAT(page_of(d), Contains("<h1>drive_lag and com_forward explain 85 % of the gap from command to drive</h1>") &&
                             Contains("<td>12 % (11 %)</td>"));
  // one of them without a name: of the other its own share
  d.stages[0].decision.effects.back().doubts = {Doubt::not_held_out};
  CHECK_THAT(
      page_of(d),
      Contains(
          "<h1>drive_lag explains 84 % of the gap from command to drive (85 % together with unnamed effects)</h1>") &&
          Contains("it explains only 11 % of the gap in track speed on manoeuvres held out"));
}

TEST_CASE("What is not known is a dash, never a number") {
  Diagnosis d = made_diagnosis();
  for (StageDiagnosis& stage : d.stages) {
    constexpr double kUnknown = GapMeasure::kNotMeasured;
    stage.gap = stage.gap_by_manoeuvre = {};
    stage.decision.effects[0].value.value = {0.05, kUnknown, kUnknown};
    stage.decision.effects[0].share =
        stage.decision.effects[0].share_by_manoeuvre = {kUnknown, kUnknown, kUnknown, 0, kUnknown};
    stage.decision.effects[0].evidence = kUnknown;
    stage.ranking[0].explains = kUnknown;
    stage.where.beyond_chance = 0;
    stage.where.channels[0] = {channel("x_m"), kUnknown, 0, 0};
  }
  CHECK_THAT(page_of(d), Contains("0.05 s (- to -)"));
}

TEST_CASE("A diagnosis that was interrupted still has a page, which says so before anything else") {
  Diagnosis d;
  d.interrupted = "simulating the nominal robot";
  const std::string early = page_of(d);
  CHECK_THAT(early, Contains("<h1>Unfinished: interrupted while simulating the nominal robot</h1>") &&
                        Contains("there is no verdict") && !Contains("No gap"));

  d = made_diagnosis();
  d.interrupted = "drive to body";
  d.verdict = Verdict::unknown;
  d.largest_stage.reset();
  d.stages.pop_back();
  const std::string late = page_of(d);
  CHECK_THAT(late, Contains("<h1>Unfinished: interrupted while drive to body</h1>") && Contains("climb") &&
                       !Contains("Use <b>robot.toml"));
}

TEST_CASE("Runs without repeats and without any visible effect have a page") {
  Diagnosis d = made_without_gap();
  for (StageDiagnosis& stage : d.stages) {
    stage.nominal_floor.from_repeats = false;
    stage.ranking.clear();
    stage.isolability = {};
  }
  CHECK_THAT(page_of(d), Contains("none repeats another") && Contains("No effect in this stage shows in these runs"));
}

TEST_CASE("Where no next manoeuvre was asked for, the page says that, not that none is needed") {
  Diagnosis d = made_diagnosis();
  d.options.propose_next = false;
  CHECK_THAT(page_of(d), Contains("No proposal was requested.") && !Contains("leave no effects to distinguish"));
}

TEST_CASE("Doubts are in words, with the numbers they go by") {
  Diagnosis d = made_diagnosis();
  StageDiagnosis& stage = d.stages[1];
  ModelEffect& effect = stage.decision.effects[0];
  const auto doubt = [&](Doubt of) {
    effect.doubts = {of};
    return answers_of(d);
  };
  const Candidate& com = d.candidates[com_forward];
  CHECK_THAT(doubt(Doubt::end_of_range),
             Contains("its value is at the end of its range (" + figure(com.min) + " to " + figure(com.max) + " m)"));
  effect.ordinarily_off = 0.004;
  CHECK_THAT(doubt(Doubt::ordinary), Contains("a typical error of this number is as large (1 sigma: 0.004 m)"));
  effect.share.of_kind = 0.2;
  effect.share_by_manoeuvre.of_kind = 0.03;
  CHECK_THAT(doubt(Doubt::not_held_out),
             Contains("it explains only 3 % of the gap in track speed on manoeuvres held out"));
  effect.share.model_of_kind = 0.31;
  effect.share_by_manoeuvre.model_of_kind = 0.4;
  CHECK_THAT(doubt(Doubt::little_explained),
             Contains("all effects together explain only 31 % of the gap in track speed on runs held out"));
  effect.candidate = track_separation;  // of a number of the description, from where it is described
  CHECK_THAT(doubt(Doubt::disagreement), Contains("differ by more than its change from "));
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
  Diagnosis d = made_diagnosis();
  StageDiagnosis& drive = d.stages[0];
  for (std::size_t r = 0; r < drive.residuals.size(); ++r)
    for (std::size_t b = 0; b < d.features.of(drive.passage)[r].bins.size(); ++b) {
      const std::size_t c = d.features.of(drive.passage)[r].bins[b].channel;
      drive.residuals[r][static_cast<Eigen::Index>(b)] = c == channel("track_left_mps") ? 0.30 : 0.29;
    }
  const std::vector<Overlay> overlays = overlays_of(d);
  REQUIRE(overlays.size() == 2);
  for (const Overlay& overlay : overlays) {
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
  d.stages.resize(1);
  d.stages[0].decision.verdict = Verdict::unknown;
  d.stages[0].decision.data.groups.resize(1);
  d.stages[0].decision.data.groups[0].bins.resize(1);
  d.stages[0].gap.before = 2, d.stages[0].gap.floor = 1;
  for (std::size_t g = 0; g < 30; ++g) {
    d.repeats.push_back({g});
    d.stages[0].where.phases.push_back({"m", "cruise", 0, 1, 0, 0, g == 3 || g == 20 ? 0.3 : 0.01, g});
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

TEST_CASE("Manoeuvres of one name are distinguished by their files") {
  Diagnosis d = made_diagnosis();
  CHECK(group_title(d, 0) == "drive");
  d.observations.runs[2].manoeuvre = "drive";
  CHECK(group_title(d, 0) == "drive (run-000.csv)");
  CHECK(group_title(d, 1) == "drive (run-002.csv)");
  d.observations.runs[2].manoeuvre = "";
  CHECK(group_title(d, 1) == "run-002.csv");
}
