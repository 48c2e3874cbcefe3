// What a challenge's score counts, on keys and reports that are written here, without any simulation.
#include "gap/challenge/score.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "formats/runs/dataset.hpp"
#include "gap/challenge/sha256.hpp"
#include "tests/gap/kenaf_gap.hpp"

using namespace kenaf;
using namespace kenaf::gap;
using namespace kenaf::gap::challenge;
using test::read_file;
using test::TemporaryFolder;
using test::write_file;

namespace {

// Names of the catalogue; each has one parameter.
const HiddenEffect kMass{"mass", "scale", 3, 1.2}, kDelay{"command_delay", "delay_s", 3, 0.1};

CasePlan plan_of(Stratum stratum, std::vector<HiddenEffect> effects = {}) {
  CasePlan plan;
  plan.name = "case-000";
  plan.stratum = stratum;
  plan.effects = std::move(effects);
  if (stratum == Stratum::foreign) plan.foreign = "drives_fade", plan.foreign_floors = 3;
  if (is_outside(stratum)) plan.look_alike = {"com_up", 40};
  return plan;
}

using Names = std::vector<std::string>;

// Of a stage, and of a report in which no other stage has a gap.
ReadStage stage(std::string verdict, Names named = {}, std::vector<Names> sets = {}) {
  ReadStage result;
  result.stage = "drive to body";
  result.verdict = std::move(verdict);
  result.named = std::move(named);
  result.ambiguous_sets = std::move(sets);
  return result;
}
ReadReport in_stages(std::string verdict, std::vector<ReadStage> stages) {
  ReadReport result;
  result.verdict = std::move(verdict);
  for (const ReadStage& one : stages) {
    result.named.insert(result.named.end(), one.named.begin(), one.named.end());
    result.ambiguous_sets.insert(result.ambiguous_sets.end(), one.ambiguous_sets.begin(), one.ambiguous_sets.end());
  }
  result.stages = std::move(stages);
  return result;
}
ReadReport reported(const std::string& verdict, Names named = {}, std::vector<Names> sets = {}) {
  return in_stages(verdict, {stage(verdict, std::move(named), std::move(sets))});
}
// With what it says of mass.
ReadReport mass_reported(double value, double from, double to, ReadReport report = reported("named", {"mass"})) {
  report.stages.front().effects = {{"mass", "scale", value, from, to}};
  return report;
}

ScoredCase scored(CasePlan plan, std::optional<ReadReport> report, CaseShrinks shrinks = {}) {
  return {{std::move(plan), ""}, std::move(report), shrinks};
}

Figure figure(const std::vector<ScoredCase>& cases, std::string_view id) {
  for (const Figure& f : figures(cases))
    if (f.id == id) return f;
  FAIL("no figure " << id);
  return {};
}

std::vector<ScoredCase> times(std::size_t right, const ScoredCase& good, std::size_t wrong, const ScoredCase& bad) {
  std::vector<ScoredCase> cases(right, good);
  cases.insert(cases.end(), wrong, bad);
  return cases;
}

}  // namespace

TEST_CASE("A single is found by its name, or in the only set reported") {
  const CasePlan plan = plan_of(Stratum::single, {kMass});
  CHECK(judge(plan, reported("named", {"mass"})).right);
  CHECK(judge(plan, reported("named", {"mass"})).named_alone);
  CHECK(judge(plan, reported("ambiguous", {}, {{"com_up", "mass"}})).right);
  CHECK_FALSE(judge(plan, reported("ambiguous", {}, {{"com_up", "mass"}})).named_alone);

  CHECK_FALSE(judge(plan, reported("none")).right);
  CHECK_FALSE(judge(plan, reported("unknown")).right);
  CHECK_FALSE(judge(plan, reported("named", {"com_up"})).right);
  CHECK_FALSE(judge(plan, reported("ambiguous", {}, {{"com_up", "com_left"}})).right);
  CHECK_FALSE(judge(plan, reported("named", {"mass", "com_up"})).right);  // there is no second one
  CHECK_FALSE(judge(plan, reported("ambiguous", {}, {{"mass", "com_up"}, {"drive_lag", "command_delay"}})).right);
  CHECK_FALSE(judge(plan, std::nullopt).right);
}

TEST_CASE("A pair is found where each of it has a name or a set of its own") {
  const CasePlan plan = plan_of(Stratum::pair, {kMass, kDelay});
  CHECK(judge(plan, reported("named", {"command_delay", "mass"})).right);
  CHECK(judge(plan, reported("ambiguous", {"mass"}, {{"drive_lag", "command_delay"}})).right);
  CHECK(judge(plan, reported("ambiguous", {}, {{"drive_lag", "command_delay"}, {"com_up", "mass"}})).right);
  CHECK(judge(plan, reported("ambiguous", {}, {{"mass", "command_delay"}, {"com_up", "mass"}})).right);

  CHECK_FALSE(judge(plan, reported("named", {"mass"})).right);
  CHECK_FALSE(judge(plan, reported("named", {"mass", "com_up"})).right);
  CHECK_FALSE(judge(plan, reported("ambiguous", {}, {{"mass", "command_delay"}})).right);  // the one or the other
  CHECK_FALSE(judge(plan, reported("unknown")).right);
}

TEST_CASE("What two stages claim is one effect where both can stand for it, two claims of one stage are two") {
  const CasePlan single = plan_of(Stratum::single, {kMass}), pair = plan_of(Stratum::pair, {kMass, kDelay});
  const auto both = [](const ReadStage& first, const ReadStage& second) {
    return in_stages("ambiguous", {first, second});
  };
  CHECK(judge(single, both(stage("named", {"mass"}), stage("named", {"mass"}))).right);
  CHECK(judge(single, both(stage("named", {"mass"}), stage("ambiguous", {}, {{"mass", "com_up"}}))).right);
  CHECK(judge(single, both(stage("none"), stage("ambiguous", {}, {{"mass", "com_up"}}))).right);
  CHECK_FALSE(judge(single, both(stage("named", {"mass"}), stage("named", {"com_up"}))).right);
  CHECK_FALSE(judge(single, both(stage("named", {"mass"}), stage("ambiguous", {}, {{"com_up", "com_left"}}))).right);
  CHECK_FALSE(judge(single, reported("ambiguous", {"mass"}, {{"mass", "com_up"}})).right);

  CHECK(judge(pair, both(stage("named", {"command_delay"}), stage("named", {"mass"}))).right);
  // the second stage's set stands for whichever of the two the first one leaves
  CHECK(
      judge(pair, both(stage("named", {"command_delay"}), stage("ambiguous", {}, {{"command_delay", "mass"}}))).right);
  CHECK_FALSE(judge(pair, both(stage("named", {"mass"}), stage("ambiguous", {}, {{"com_up", "mass"}}))).right);
}

TEST_CASE("A number of the description stands for the effect that does the same") {
  const CasePlan plan = plan_of(Stratum::single, {kMass});
  CHECK(judge(plan, reported("named", {"body.mass_kg"})).right);
  CHECK_FALSE(judge(plan, reported("named", {"body.mass_kg"})).names_wrong);
  CHECK(judge(plan, reported("named", {"flipper.mass_kg"})).names_wrong);
  CHECK(judge(plan_of(Stratum::pair, {kMass, kDelay}), reported("named", {"body.mass_kg", "command_delay"})).right);
  // of a withheld effect that is wrong like any other name
  CHECK(judge(plan_of(Stratum::withheld, {kMass}), reported("named", {"body.mass_kg"})).names_wrong);
}

TEST_CASE("What the catalogue does not have is unknown, none is missed, a name is wrong") {
  for (const CasePlan& plan : {plan_of(Stratum::withheld, {kMass}), plan_of(Stratum::foreign)}) {
    CHECK(judge(plan, reported("unknown")).right);
    CHECK_FALSE(judge(plan, reported("none")).right);
    CHECK_FALSE(judge(plan, reported("none")).names_wrong);
    CHECK_FALSE(judge(plan, reported("ambiguous", {}, {{"com_up", "com_left"}})).right);
    CHECK_FALSE(judge(plan, reported("named", {"com_up"})).right);
    CHECK(judge(plan, reported("named", {"com_up"})).names_wrong);
  }
}

TEST_CASE("A name is wrong where it is not hidden, also in addition to right ones, and a set is no name") {
  const CasePlan single = plan_of(Stratum::single, {kMass});
  CHECK_FALSE(judge(single, reported("named", {"mass"})).names_wrong);
  CHECK(judge(single, reported("named", {"mass", "com_up"})).names_wrong);
  CHECK(judge(single, reported("ambiguous", {"com_up"}, {{"mass", "com_left"}})).names_wrong);
  CHECK_FALSE(judge(single, reported("ambiguous", {}, {{"com_up", "com_left"}})).names_wrong);
  CHECK(judge(plan_of(Stratum::none), reported("named", {"mass"})).names_wrong);
}

TEST_CASE("An effect is distinguishable where no other is within 10 degrees of it in the report's table") {
  const CasePlan plan = plan_of(Stratum::single, {kMass});
  ReadReport report = reported("unknown");
  report.table.effects = {"com_up", "mass", "drive_lag"};
  report.table.angle_deg = {{0, 10, 5}, {10, 0, 60}, {5, 60, 0}};  // com_up and drive_lag are alike, mass is not
  CHECK(judge(plan, report).distinguishable);
  report.table.angle_deg[1][0] = 9.9;
  CHECK_FALSE(judge(plan, report).distinguishable);
  report.table.effects = {"com_up", "com_left", "drive_lag"};  // not seen at all
  CHECK_FALSE(judge(plan, report).distinguishable);
}

TEST_CASE("A cause outside the catalogue is distinguishable where nothing in it is within 10 degrees of it") {
  CasePlan plan = plan_of(Stratum::withheld, {kMass});
  CHECK(judge(plan, reported("unknown")).distinguishable);
  plan.look_alike.angle_deg = 9.9;
  CHECK_FALSE(judge(plan, reported("unknown")).distinguishable);

  // three right of five that are distinguishable; the others count only in the figures of all cases
  const ScoredCase apart_right = scored(plan_of(Stratum::foreign), reported("unknown"));
  const ScoredCase apart_wrong = scored(plan_of(Stratum::foreign), reported("named", {"com_up"}));
  std::vector<ScoredCase> cases = times(3, apart_right, 2, apart_wrong);
  cases.push_back(scored(plan, reported("named", {"com_up"})));
  CHECK(figure(cases, "outside_unknown").cases == 6);
  CHECK(figure(cases, "outside_unknown").value == Approx(0.5));
  CHECK(figure(cases, "outside_apart_unknown").cases == 5);
  CHECK(figure(cases, "outside_apart_unknown").value == Approx(0.6));
  CHECK(figure(cases, "wrong_name").value == Approx(0.5));
  CHECK(figure(cases, "wrong_name_apart").value == Approx(0.4));
}

TEST_CASE("Shares count the cases that they are of") {
  const ScoredCase found = scored(plan_of(Stratum::single, {kMass}), reported("named", {"mass"}));
  const ScoredCase missed = scored(plan_of(Stratum::single, {kMass}), reported("none"));
  const ScoredCase quiet = scored(plan_of(Stratum::none), reported("none"));
  const ScoredCase alarm = scored(plan_of(Stratum::none), reported("named", {"mass"}));

  const std::vector<ScoredCase> met = times(19, found, 1, missed);  // 95 %
  CHECK(figure(met, "single_found").cases == 20);
  CHECK(figure(met, "single_found").value == Approx(0.95));
  CHECK(figure(met, "single_found").met);
  CHECK_FALSE(figure(times(18, found, 1, missed), "single_found").met);
  CHECK(figure(met, "pair_found").cases == 0);
  CHECK_FALSE(figure(met, "pair_found").met);
  CHECK(figure(times(99, quiet, 1, alarm), "none_none").met);
  CHECK_FALSE(figure(times(98, quiet, 1, alarm), "none_none").met);

  const auto wrong = times(49, quiet, 1, alarm);  // 2 % of all cases
  CHECK(figure(wrong, "wrong_name").value == Approx(0.02));
  CHECK(figure(wrong, "wrong_name").met);
  CHECK_FALSE(figure(times(48, quiet, 1, alarm), "wrong_name").met);

  const ScoredCase unknown = scored(plan_of(Stratum::withheld, {kMass}), reported("unknown"));
  const ScoredCase foreign_missed = scored(plan_of(Stratum::foreign), reported("none"));
  CHECK(figure(times(9, unknown, 1, foreign_missed), "outside_unknown").met);
  CHECK_FALSE(figure(times(8, unknown, 1, foreign_missed), "outside_unknown").met);

  const ScoredCase both = scored(plan_of(Stratum::pair, {kMass, kDelay}), reported("named", {"mass", "command_delay"}));
  const ScoredCase one = scored(plan_of(Stratum::pair, {kMass, kDelay}), reported("named", {"mass"}));
  CHECK(figure(times(4, both, 1, one), "pair_found").met);
  CHECK_FALSE(figure(times(3, both, 1, one), "pair_found").met);
}

TEST_CASE("Named alone is asked of singles that are distinguishable in the report's table") {
  ReadReport apart = reported("ambiguous", {}, {{"mass", "com_up"}});
  apart.table.effects = {"mass", "com_up"};
  apart.table.angle_deg = {{0, 40}, {40, 0}};
  ReadReport alike = apart, named = reported("named", {"mass"});
  alike.table.angle_deg = {{0, 4}, {4, 0}};
  named.table = apart.table;
  const CasePlan plan = plan_of(Stratum::single, {kMass});
  CHECK(figure({scored(plan, alike)}, "single_named").cases == 0);
  CHECK(figure(times(9, scored(plan, named), 1, scored(plan, apart)), "single_named").met);
  CHECK_FALSE(figure(times(8, scored(plan, named), 1, scored(plan, apart)), "single_named").met);
}

TEST_CASE("What is smaller than 2 floors counts only where it is named wrongly") {
  HiddenEffect small = kMass;
  small.floors = 1.9;
  const auto cases = std::vector{scored(plan_of(Stratum::single, {small}), reported("none")),
                                 scored(plan_of(Stratum::single, {small}), reported("named", {"com_up"})),
                                 scored(plan_of(Stratum::pair, {kDelay, small}), reported("named", {"command_delay"}))};
  CHECK(figure(cases, "single_found").cases == 0);
  CHECK(figure(cases, "pair_found").cases == 0);
  CHECK(figure(cases, "wrong_name").value == Approx(1.0 / 3));
  // listed apart from the others
  const std::string text = score_markdown({cases[0]});
  CHECK(text.find("mass:scale=1.2 (1.9 floors)") > text.find("called none: no error"));
  CHECK(score_markdown({cases[1]}).find("mass:scale=1.2 (1.9 floors)") <
        score_markdown({cases[1]}).find("called none: no error"));
}

TEST_CASE("Intervals are asked of hidden effects that are named") {
  const ReadReport holds = mass_reported(1.19, 1.15, 1.2);  // 1.2 is hidden
  const ReadReport off = mass_reported(1.1, 1.05, 1.19);
  const ReadReport set = mass_reported(1.1, 1.05, 1.19, reported("ambiguous", {}, {{"mass", "com_up"}}));
  const CasePlan plan = plan_of(Stratum::single, {kMass});
  CHECK(figure({scored(plan, set)}, "interval_covers").cases == 0);
  CHECK(figure(times(19, scored(plan, holds), 1, scored(plan, off)), "interval_covers").met);
  CHECK_FALSE(figure(times(17, scored(plan, holds), 2, scored(plan, off)), "interval_covers").met);  // 89 %
  // intervals that hold the value always are too wide for 95 %
  CHECK_FALSE(figure(times(20, scored(plan, holds), 0, scored(plan, off)), "interval_covers").met);
}

TEST_CASE("The width of intervals shows in the median error of the values") {
  // 1.2 is hidden. Half widths of the side on which it lies: 0.04 of 0.1, 0.05 of 0.1, 0.1 of 0.05.
  const CasePlan plan = plan_of(Stratum::single, {kMass});
  const auto with = [&](double value, double from, double to) { return scored(plan, mass_reported(value, from, to)); };
  const std::vector<ScoredCase> cases{with(1.16, 1.15, 1.26), with(1.25, 1.15, 1.26), with(1.1, 1.0, 1.15)};
  CHECK(figure(cases, "interval_off").cases == 3);
  CHECK(figure(cases, "interval_off").value == Approx(0.5));
  // of so few, anywhere between the least and the most
  CHECK(figure(cases, "interval_off").from == Approx(0.4));
  CHECK(figure(cases, "interval_off").to == Approx(2));
  CHECK(figure({scored(plan, reported("unknown"))}, "interval_off").cases == 0);
  CHECK(figure({scored(plan_of(Stratum::withheld, {kMass}), cases[0].report)}, "interval_off").cases == 0);

  // the one that does not hold it is listed, and in score.json are all
  const std::string text = score_markdown(cases);
  CHECK(text.find("| case-000 | mass | 1.2 | 1.1 | 1 to 1.15 |") != std::string::npos);
  CHECK(text.find("1.15 to 1.26") == std::string::npos);
  const auto json = nlohmann::json::parse(score_json(cases));
  CHECK(json["cases"][0]["intervals"][0]["hidden"] == 1.2);
  CHECK(json["cases"][0]["intervals"][0]["ci95"][1] == 1.26);
}

TEST_CASE("Ground that gives is measured in contacts of the model, not in those of the robot") {
  // The robot's contacts are half as stiff as the model's (100 for 200 kN/m): ground that gives 3 times as much gives 6
  // times as much as the model's own. Twice the damping: 1.5 times that is 3 times the model's.
  CasePlan plan = plan_of(Stratum::single, {{"ground_compliance", "scale", 3, 3}});
  plan.physics.contact_stiffness_npm = 1e5;
  plan.physics.contact_damping_nspm = 2000;
  CHECK(value_in_model(plan, plan.effects.front()) == Approx(6));
  CHECK(value_in_model(plan, {"ground_damping", "scale", 3, 1.5}) == Approx(3));
  CHECK(value_in_model(plan, kMass) == kMass.value);
  ReadReport report = reported("named", {"ground_compliance"});
  report.stages.front().effects = {{"ground_compliance", "scale", 5.9, 5.5, 6.3}};
  CHECK(figure({scored(plan, report)}, "interval_covers").value == 1);
}

TEST_CASE("Shrinks are compared with those of the hidden effect, where there is a gap to shrink") {
  const auto with = [](double before, double report, double truth) {
    CaseShrinks shrinks;
    shrinks.unseen = Shrinks{before, 1, report, truth};
    shrinks.heldout = {*shrinks.unseen};
    return scored(plan_of(Stratum::single, {kMass}), reported("named", {"mass"}), shrinks);
  };
  // 0.04 less and 0.06 more than the truth's: 0.05 on average
  const std::vector<ScoredCase> two{with(3, 0.90, 0.94), with(3, 0.96, 0.90)};
  for (const char* id : {"shrink_heldout", "shrink_unseen"}) {
    CHECK(figure(two, id).value == Approx(0.05));
    CHECK(figure({with(3, 0.90, 0.94)}, id).met);
    CHECK_FALSE(figure({with(3, 0.84, 0.90)}, id).met);
    CHECK(figure({with(1.4, 0.1, 0.9)}, id).cases == 0);
  }
  CHECK(figure(two, "shrink_heldout_close").value == Approx(0.5));
}

TEST_CASE("Wilson's interval of a share") {
  // 1 of 10: (0.1 + 0.19208 -+ 1.96 sqrt(0.009 + 0.009604)) / 1.38416
  const Share share = wilson(1, 10);
  CHECK(share.value == Approx(0.1));
  CHECK(share.from == Approx(0.017877).epsilon(1e-3));
  CHECK(share.to == Approx(0.404155).epsilon(1e-3));
  CHECK(wilson(0, 5).from == 0);
  CHECK(wilson(5, 5).to == 1);
}

TEST_CASE("By effect, by size and outside the catalogue, every case is counted once") {
  HiddenEffect small = kMass, large = kMass;
  small.floors = 0.7;
  large.floors = 5.2;  // planned 5, made a little larger
  const std::vector<ScoredCase> cases{
      scored(plan_of(Stratum::single, {small}), reported("none")),
      scored(plan_of(Stratum::single, {large}), reported("named", {"mass"})),
      scored(plan_of(Stratum::single, {kMass}), reported("ambiguous", {}, {{"mass", "com_up"}})),
      scored(plan_of(Stratum::pair, {kMass, kDelay}), reported("named", {"command_delay", "com_up"})),
      scored(plan_of(Stratum::withheld, {kMass}), reported("named", {"com_up"})),
      scored(plan_of(Stratum::foreign), reported("unknown"))};
  const auto effects = scores_by_effect(cases);
  REQUIRE(effects.size() == 2);
  CHECK(effects[0].name == "command_delay");
  CHECK((effects[0].hidden == 1 && effects[0].named == 1));
  CHECK((effects[1].hidden == 4 && effects[1].named == 1 && effects[1].ambiguous == 1 && effects[1].missed == 1 &&
         effects[1].wrong == 1));
  CHECK(effects[1].smallest_found_floors == 3);

  const auto sizes = scores_by_size(cases);
  CHECK((sizes[1].cases == 1 && sizes[1].seen == 0));                                // 0.7
  CHECK((sizes[3].cases == 1 && sizes[3].found == 1 && sizes[3].named_alone == 0));  // 3
  CHECK((sizes[4].cases == 1 && sizes[4].named_alone == 1));                         // 5.2

  const auto outside = scores_outside(cases);
  REQUIRE(outside.size() == 2);
  CHECK((outside[0].name == "drives_fade" && outside[0].unknown == 1));
  CHECK((outside[1].name == "without mass" && outside[1].named == 1));
}

TEST_CASE("SHA-256 gives what its standard's examples say") {
  CHECK(sha256("abc") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  CHECK(sha256("") == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

namespace {

// A finished challenge of one case.
void write_challenge(const TemporaryFolder& folder) {
  namespace fs = std::filesystem;
  const fs::path data = case_folder(folder.path(), "case-000"), report = report_folder(folder.path(), "case-000");
  fs::create_directories(data);
  fs::create_directories(report);
  write_file(data / "run-000.csv", "t_s,x_m\n0,0\n1,1\n");
  runs::write_dataset(data, {.source = "real",
                             .robot = "kenaf",
                             .world = "flat",
                             .description = "case-000",
                             .noise = {},
                             .runs = {{"run-000.csv", "straight", "flat", {}}}});
  write_file(report / "report.json", R"({"format": "kenaf-gap-report/1", "verdict": "none", "named": [],
    "ambiguous_sets": [], "effects": [], "gap": {"shrink": 0}, "isolability": {"effects": [], "angle_deg": []}})");
  CasePlan plan = plan_of(Stratum::none);
  plan.manoeuvres = {"straight"};
  const std::string key = key_text({11, {{plan, sha256_of_dataset(data)}}});
  write_file(folder / "commitment.txt", commitment_text(key));
  write_file(folder / "key.json", key);
}

}  // namespace

TEST_CASE("A key is read back as it was written") {
  CasePlan plan = plan_of(Stratum::pair, {kMass, kDelay});
  plan.manoeuvres = {"straight", "arc"};
  plan.unseen = "drop";
  plan.seed = 0xffffffffffffffff;
  plan.physics.contact_stiffness_npm = 123456.789;
  const std::string text = key_text({17, {{plan, "data"}, {plan_of(Stratum::foreign), ""}}});
  const ChallengeKey key = read_key(text);
  CHECK(key.cases.at(0).plan.effects.at(1).value == 0.1);
  CHECK(key.cases.at(0).plan.seed == 0xffffffffffffffff);
  CHECK(key.cases.at(1).plan.foreign == "drives_fade");
  CHECK(key.cases.at(1).plan.look_alike.effect == "com_up");
  CHECK(key.cases.at(1).plan.look_alike.angle_deg == 40);
  CHECK(key_text(key) == text);
  CHECK(key_text({18, key.cases}) != text);
  CHECK_THROWS_WITH(read_key("{\"format\": 1}"), Catch::Contains("key.json is not the key"));
  const auto with = [](CasePlan other) { return key_text({17, {{std::move(other), ""}}}); };
  CHECK_THROWS_WITH(read_key(with(plan_of(Stratum::single))),
                    Catch::Contains("does not hide the effects of its stratum"));
  CHECK_THROWS_WITH(read_key(with(plan_of(Stratum::single, {{"mess", "scale", 3, 1.2}}))),
                    Catch::Contains("mess:scale"));
  CHECK_THROWS_WITH(read_key(with(plan_of(Stratum::single, {{"mass", "scale", 3, -1}}))),
                    Catch::Contains("out of its range"));
  CasePlan endless = plan_of(Stratum::none);
  endless.repeats = -1;  // would be 18446744073709551615 of them
  CHECK_THROWS_WITH(read_key(with(endless)), Catch::Contains("that is out of range"));
  endless = plan_of(Stratum::none);
  endless.physics.time_step_s = 1e-300;
  CHECK_THROWS_WITH(read_key(with(endless)), Catch::Contains("that is out of range"));
}

TEST_CASE("A finished challenge is scored, a key or data that were changed are refused") {
  const TemporaryFolder folder;
  write_challenge(folder);
  const test::Outcome outcome = test::kenaf_gap(folder, "score .");
  CAPTURE(outcome.error);
  REQUIRE(outcome.status == 0);
  CHECK_THAT(outcome.out,
             Catch::Contains("| nothing hidden, called none | 1 of 1 | 100.0 % | 20.7 % to 100.0 % | >= 99 % | met |"));
  CHECK(read_file(folder / "score.md") == outcome.out);
  const auto json = nlohmann::json::parse(read_file(folder / "score.json"));
  CHECK(json.at("cases").at(0).at("right") == true);
  CHECK(std::system(("cd '" + folder.path().string() + "' && sha256sum --check --status commitment.txt").c_str()) == 0);

  std::string key = read_file(folder / "key.json");
  key.replace(key.find("\"none\""), 6, "\"pair\"");
  write_file(folder / "key.json", key);
  const test::Outcome changed = test::kenaf_gap(folder, "score .");
  CHECK(changed.status == 2);
  CHECK_THAT(changed.error, Catch::Contains("key.json does not match commitment.txt"));

  write_challenge(folder);
  write_file(case_folder(folder.path(), "case-000") / "run-000.csv", "t_s,x_m\n0,0\n1,2\n");
  const test::Outcome other = test::kenaf_gap(folder, "score .");
  CHECK(other.status == 2);
  CHECK_THAT(other.error, Catch::Contains("case-000: the data does not match its seal"));
}

TEST_CASE(
    "Without data that was sealed a challenge is scored but for what takes simulations, or by data that is the same") {
  const TemporaryFolder folder;
  write_challenge(folder);
  std::filesystem::remove_all(folder / "cases");
  const test::Outcome without = test::kenaf_gap(folder, "score . --no-shrinks");
  CAPTURE(without.error);
  CHECK(without.status == 0);
  const test::Outcome other = test::kenaf_gap(folder, "score .");  // its data were written by hand
  CHECK(other.status == 2);
  CHECK_THAT(other.error,
             Catch::Contains("case-000: the data that this program makes from the key does not match the sealed data"));
}

TEST_CASE("A key that is enciphered is read with its seed only, and only where it is what was sealed") {
  const TemporaryFolder folder;
  write_challenge(folder);
  const std::string key = read_file(folder / "key.json"), text = enciphered(key, 11);
  std::filesystem::remove(folder / "key.json");
  CHECK(text.find("straight") == std::string::npos);
  CHECK(deciphered(text, 11) == key);
  CHECK(deciphered(text, 12) != key);
  CHECK_FALSE(sealed_key(folder.path(), 11));  // not there yet
  write_file(folder / "key.enciphered", text);
  REQUIRE(sealed_key(folder.path(), 11));
  CHECK(key_text(*sealed_key(folder.path(), 11)) == key);
  CHECK_FALSE(sealed_key(folder.path(), 12));
  write_file(folder / "key.enciphered", "no key" + text);
  CHECK_FALSE(sealed_key(folder.path(), 11));
  write_file(folder / "key.enciphered", text);
  write_file(folder / "commitment.txt", commitment_text("another key"));
  CHECK_FALSE(sealed_key(folder.path(), 11));
}

TEST_CASE("A case that was made is kept for who has the seed, until its data are other ones") {
  const TemporaryFolder folder;
  write_challenge(folder);
  const SealedCase sealed = open_key(folder.path()).cases.at(0);
  const std::filesystem::path cases = folder.path() / "cases", kept = cases / "case-000.enciphered";
  CHECK_FALSE(made_case(cases, "case-000", 11, 1));  // not there yet
  keep_made_case(cases, sealed, 11, 1);
  CHECK(read_file(kept).find("straight") == std::string::npos);
  REQUIRE(made_case(cases, "case-000", 11, 1));
  CHECK(key_text({11, {*made_case(cases, "case-000", 11, 1)}}) == key_text({11, {sealed}}));
  CHECK_FALSE(made_case(cases, "case-000", 12, 1));
  CHECK_FALSE(made_case(cases, "case-000", 11, 2));  // the same seed plans other cases
  CHECK_FALSE(made_case(cases, "case-001", 11, 1));
  // one text of a challenge does not give another one away: the same bytes are others in each
  CHECK(read_file(kept).substr(0, 64) != enciphered(key_text({11, {sealed}}), 11).substr(0, 64));
  write_file(cases / "case-000" / "run-000.csv", "t_s,x_m\n0,0\n1,2\n");
  CHECK_FALSE(made_case(cases, "case-000", 11, 1));
}

namespace {

// Of one case with seed 11, made, not sealed; what is in it is not what its seed would make, so that it is known again.
ChallengeKey write_half_made_challenge(const TemporaryFolder& folder) {
  write_challenge(folder);
  std::filesystem::rename(folder / "cases", folder / "cases.part");
  ChallengeKey key = read_key(read_file(folder / "key.json"));
  key.cases[0].data_sha256 = sha256_of_dataset(folder.path() / "cases.part/case-000");
  keep_made_case(folder.path() / "cases.part", key.cases[0], 11, 1);
  for (const char* file : {"key.json", "commitment.txt"}) std::filesystem::remove(folder / file);
  return key;
}

}  // namespace

TEST_CASE("A challenge that is interrupted while its cases are made goes on with those that are there") {
  const TemporaryFolder folder;
  const ChallengeKey key = write_half_made_challenge(folder);
  std::filesystem::create_directory(folder / "cases.part/case-001");  // of more cases that were asked for once
  const test::Outcome outcome = test::kenaf_gap(folder, "challenge --out . --cases 1 --seed 11");
  CAPTURE(outcome.error);
  CHECK(outcome.status == 0);
  CHECK(read_file(folder / "key.json") == key_text(key));
  CHECK(std::filesystem::exists(folder / "cases/case-000"));
  CHECK_FALSE(std::filesystem::exists(folder / "cases/case-000.enciphered"));
  CHECK_FALSE(std::filesystem::exists(folder / "cases/case-001"));
  CHECK_FALSE(std::filesystem::exists(folder / "cases.part"));
}

TEST_CASE("Cases that were being made are not thrown away for another seed or number") {
  const TemporaryFolder folder;
  write_half_made_challenge(folder);
  for (const char* slip : {"--cases 1 --seed 12", "--cases 2 --seed 11"}) {
    const test::Outcome outcome = test::kenaf_gap(folder, "challenge --out . " + std::string(slip));
    CHECK(outcome.status == 2);
    CHECK_THAT(outcome.error, Catch::Contains("contains cases of another --seed, --cases, --imperfect or --engine"));
  }
  CHECK(made_case(folder / "cases.part", "case-000", 11, 1));
}

TEST_CASE("A sealed challenge is not made again for a slip in its seed") {
  const TemporaryFolder folder;
  write_challenge(folder);
  write_file(folder / "key.enciphered", enciphered(read_file(folder / "key.json"), 11));
  std::filesystem::remove(folder / "key.json");
  CHECK(is_sealed_by_another(folder.path(), 12));
  CHECK_FALSE(is_sealed_by_another(folder.path(), 11));
  const test::Outcome outcome = test::kenaf_gap(folder, "challenge --out . --cases 1 --seed 12");
  CHECK(outcome.status == 2);
  CHECK_THAT(outcome.error, Catch::Contains("was sealed with another --seed"));
  write_file(folder / "key.enciphered", "damaged");
  CHECK_FALSE(is_sealed_by_another(folder.path(), 12));
}

TEST_CASE("A challenge that was interrupted goes on with the cases and reports that it has") {
  const TemporaryFolder folder;
  write_challenge(folder);
  const std::string key = read_file(folder / "key.json");
  write_file(folder / "key.enciphered", enciphered(key, 11));
  std::filesystem::remove(folder / "key.json");
  CHECK_THAT(test::kenaf_gap(folder, "challenge --out . --cases 2 --seed 11").error, Catch::Contains("give --cases 1"));
  // its only case has a report: there is nothing left to do but to show the key
  const test::Outcome outcome = test::kenaf_gap(folder, "challenge --out . --cases 1 --seed 11");
  CAPTURE(outcome.error);
  CHECK(outcome.status == 0);
  CHECK(read_file(folder / "key.json") == key);
  CHECK_FALSE(std::filesystem::exists(folder / "key.enciphered"));
  CHECK_THAT(outcome.error, !Catch::Contains("making cases"));
}

TEST_CASE("A challenge that is not finished has no score, and one that is finished is not begun again") {
  const TemporaryFolder folder;
  CHECK_THAT(test::kenaf_gap(folder, "score .").error, Catch::Contains("is not the folder of a challenge"));
  write_challenge(folder);
  CHECK_THAT(test::kenaf_gap(folder, "challenge --out . --cases 1 --seed 11").error, Catch::Contains("is finished"));
  std::filesystem::remove(folder / "key.json");
  CHECK_THAT(test::kenaf_gap(folder, "score .").error, Catch::Contains("is not finished"));
  const test::Outcome other = test::kenaf_gap(folder, "challenge --out . --cases 1");
  CHECK(other.status == 2);
  CHECK_THAT(other.error, Catch::Contains("is not empty"));
  const TemporaryFolder somebodys;
  std::filesystem::create_directory(somebodys / "cases");
  write_file(somebodys / "cases/mine.txt", "mine");
  CHECK_THAT(test::kenaf_gap(somebodys, "challenge --out . --cases 1 --seed 11").error,
             Catch::Contains("is not empty"));
  CHECK(read_file(somebodys / "cases/mine.txt") == "mine");
}
