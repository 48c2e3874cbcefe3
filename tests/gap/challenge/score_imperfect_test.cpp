// What the score of the imperfect challenge counts, on keys and reports that are written here, without any simulation.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "gap/challenge/score.hpp"

using namespace kenaf;
using namespace kenaf::gap;
using namespace kenaf::gap::challenge;

namespace {

using Names = std::vector<std::string>;

HiddenEffect hidden(const std::string& effect, const std::string& parameter, double value, double times_background) {
  return {effect, parameter, 4 * times_background, value, times_background, {{"drive to body", 0.8}}};
}
const HiddenEffect kMass = hidden("mass", "scale", 1.2, 4), kDelay = hidden("command_delay", "delay_s", 0.1, 4);

CasePlan plan_of(Stratum stratum, std::vector<HiddenEffect> effects = {}) {
  CasePlan plan;
  plan.name = "case-000";
  plan.stratum = stratum;
  plan.effects = std::move(effects);
  plan.background = {{{"track.separation_m", 0.203}}, 4};
  if (stratum == Stratum::withheld_number) plan.number = {"drive.max_force_n", 300, 16, 4};
  if (stratum == Stratum::foreign) plan.foreign = "drives_fade", plan.foreign_times_background = 4;
  if (is_outside(stratum)) plan.look_alike = {"com_up", 40};
  return plan;
}

ReadReport reported(const std::string& verdict, Names named = {}, std::vector<Names> sets = {}) {
  ReadReport report;
  report.verdict = verdict;
  report.named = named;
  report.ambiguous_sets = sets;
  report.stages.push_back({"drive to body", verdict, std::move(named), std::move(sets), {}});
  return report;
}

ScoredCase scored(CasePlan plan, std::optional<ReadReport> report) {
  return {{std::move(plan), ""}, std::move(report), {}};
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

TEST_CASE("Imperfect: an effect is found by its name or in a set, whatever else is claimed") {
  const ScoredCase by_name = scored(plan_of(Stratum::single, {kMass}), reported("named", {"mass"}));
  const ScoredCase in_set = scored(plan_of(Stratum::single, {kMass}), reported("ambiguous", {}, {{"com_up", "mass"}}));
  const ScoredCase extra = scored(plan_of(Stratum::single, {kMass}), reported("named", {"com_up", "mass"}));
  const ScoredCase missed = scored(plan_of(Stratum::single, {kMass}), reported("unknown"));
  CHECK(figure({by_name, in_set, extra}, "dominating_found").value == 1);
  CHECK(figure({by_name, in_set, extra}, "wrong_name").value == Approx(1.0 / 3));
  CHECK(figure({by_name, in_set, extra}, "dominating_only").value == Approx(1.0 / 3));
  CHECK(figure(times(9, by_name, 1, missed), "dominating_found").met);
  CHECK_FALSE(figure(times(8, by_name, 1, missed), "dominating_found").met);
}

TEST_CASE("Imperfect: what is smaller than 3 times the background need not be found, but nothing else may be named") {
  const CasePlan small = plan_of(Stratum::single, {hidden("mass", "scale", 1.1, 2.9)});
  CHECK(figure({scored(small, reported("unknown"))}, "dominating_found").cases == 0);
  CHECK(figure({scored(small, reported("named", {"com_up"}))}, "wrong_name").value == 1);
  CHECK(figure({scored(plan_of(Stratum::single, {hidden("mass", "scale", 1.1, 3)}), reported("unknown"))},
               "dominating_found")
            .cases == 1);
  CHECK(figure({scored(plan_of(Stratum::pair, {kMass, hidden("command_delay", "delay_s", 0.1, 2)}), reported("none"))},
               "pair_found")
            .cases == 0);
}

TEST_CASE("Imperfect: named alone is asked where the report's table tells the effect apart") {
  ReadReport apart = reported("named", {"mass"});
  apart.stages.front().table = {{"mass", "com_up"}, {{0, 40}, {40, 0}}};
  ReadReport in_set = reported("ambiguous", {}, {{"mass", "com_up"}});
  in_set.stages.front().table = apart.stages.front().table;
  const CasePlan plan = plan_of(Stratum::single, {kMass});
  CHECK(figure(times(4, scored(plan, apart), 1, scored(plan, in_set)), "dominating_named").met);
  CHECK_FALSE(figure(times(3, scored(plan, apart), 1, scored(plan, in_set)), "dominating_named").met);
  in_set.stages.front().table.angle_deg = {{0, 9}, {9, 0}};
  CHECK(figure({scored(plan, in_set)}, "dominating_named").cases == 0);
}

TEST_CASE("Imperfect: pairs are found where each has a name or a set of its own") {
  const CasePlan plan = plan_of(Stratum::pair, {kMass, kDelay});
  const ScoredCase both = scored(plan, reported("named", {"mass", "command_delay"}));
  const ScoredCase one = scored(plan, reported("named", {"mass"}));
  const ScoredCase either = scored(plan, reported("ambiguous", {}, {{"mass", "command_delay"}}));
  CHECK(figure(times(3, both, 1, one), "pair_found").met);
  CHECK_FALSE(figure(times(2, both, 1, one), "pair_found").met);
  CHECK(figure({either}, "pair_found").value == 0);
}

TEST_CASE("Imperfect: a name is wrong that is not hidden, one of a number that is truly off in the background too") {
  const CasePlan background = plan_of(Stratum::none);
  CHECK(judge(background, reported("named", {"track.separation_m"})).names_wrong);
  CHECK_FALSE(judge(plan_of(Stratum::single, {kMass}), reported("named", {"body.mass_kg"})).names_wrong);
  const ScoredCase quiet = scored(background, reported("unknown"));  // its gap is there
  const ScoredCase named = scored(background, reported("named", {"track.separation_m"}));
  const ScoredCase set = scored(background, reported("ambiguous", {}, {{"mass", "com_up"}}));
  CHECK(figure(times(49, quiet, 1, named), "wrong_name").met);
  CHECK_FALSE(figure(times(48, quiet, 1, named), "wrong_name").met);
  CHECK(figure(times(33, quiet, 1, named), "background_unnamed").met);  // 97.1 %
  CHECK_FALSE(figure(times(32, quiet, 1, named), "background_unnamed").met);
  CHECK(figure({set}, "background_unnamed").value == 1);
  CHECK(figure({set}, "background_unclaimed").value == 0);
  CHECK(figure({scored(background, std::nullopt)}, "background_unnamed").value == 0);
}

TEST_CASE("Imperfect: of what is outside the catalogue nothing may be named") {
  const ScoredCase quiet = scored(plan_of(Stratum::withheld, {kMass}), reported("unknown"));
  const ScoredCase also = scored(plan_of(Stratum::foreign), reported("ambiguous", {}, {{"mass", "com_up"}}));
  const ScoredCase named = scored(plan_of(Stratum::foreign), reported("named", {"com_up"}));
  CHECK(figure(times(18, quiet, 1, also), "outside_unnamed").value == 1);
  CHECK(figure(times(19, quiet, 1, named), "outside_unnamed").met);
  CHECK_FALSE(figure(times(18, quiet, 1, named), "outside_unnamed").met);  // 94.7 %
}

TEST_CASE("Imperfect: a number that the diagnosis does not search for is not to be called anything else") {
  const CasePlan plan = plan_of(Stratum::withheld_number);
  CHECK(judge(plan, reported("unknown")).right);
  CHECK(judge(plan, reported("ambiguous", {}, {{"mass", "com_up"}})).right);
  CHECK(judge(plan, reported("named", {"drive_weak"})).names_wrong);
  CHECK(figure({scored(plan, reported("named", {"drive_weak"}))}, "outside_unnamed").value == 0);
  CHECK(scores_outside({scored(plan, reported("unknown"))}).at(0).name == "without drive.max_force_n");
  CHECK_THAT(score_markdown({scored(plan, reported("named", {"drive_weak"}))}),
             Catch::Contains("drive.max_force_n=300 (4.0 times the background)"));
}

TEST_CASE("Imperfect: since a baseline the background is no part of the gap, and nothing else may be claimed") {
  const CasePlan changed = plan_of(Stratum::baseline, {kMass}), same = plan_of(Stratum::baseline);
  CHECK(judge(changed, reported("named", {"mass"})).named_alone);
  CHECK(judge(changed, reported("ambiguous", {}, {{"mass", "com_up"}})).right);
  CHECK_FALSE(judge(changed, reported("named", {"mass", "com_up"})).right);
  CHECK_FALSE(judge(changed, reported("unknown")).right);
  CHECK_FALSE(judge(changed, std::nullopt).right);
  CHECK(judge(same, reported("none")).right);
  // of a background alone these would be right
  CHECK_FALSE(judge(same, reported("unknown")).right);
  CHECK_FALSE(judge(same, reported("ambiguous", {}, {{"mass", "com_up"}})).right);
  const ScoredCase good = scored(changed, reported("named", {"mass"})), bad = scored(same, reported("unknown"));
  CHECK(figure(times(9, good, 1, bad), "baseline_right").met);
  CHECK_FALSE(figure(times(8, good, 1, bad), "baseline_right").met);
  CHECK(figure({good, bad}, "baseline_none").cases == 1);
  CHECK(figure({good, bad}, "background_unnamed").cases == 0);

  CasePlan small = plan_of(Stratum::baseline, {hidden("mass", "scale", 1.01, 0.6)});  // of 2.4 floors
  CHECK(figure({scored(small, reported("none"))}, "baseline_right").cases == 0);
  small.effects.front().floors = 2.8;
  CHECK(figure({scored(small, reported("none"))}, "baseline_right").cases == 1);
}

TEST_CASE("Imperfect: shares are reported with their cases, and with Wilson's interval") {
  const ScoredCase quiet = scored(plan_of(Stratum::none), reported("unknown"));
  const ScoredCase named = scored(plan_of(Stratum::none), reported("named", {"mass"}));
  const std::string text = score_markdown(times(33, quiet, 1, named));
  CHECK_THAT(text, Catch::Contains(
                       "| background alone, nothing named | 33 of 34 | 97.1 % | 85.1 % to 99.5 % | >= 97 % | met |"));
  const auto json = nlohmann::json::parse(score_json(times(33, quiet, 1, named)));
  for (const auto& line : json["figures"])
    if (line["id"] == "background_unnamed") CHECK((line["hits"] == 33 && line["cases"] == 34));
  // each target of docs/gap-challenge.md has a line
  for (const char* id : {"dominating_found", "dominating_named", "pair_found", "wrong_name", "background_unnamed",
                         "outside_unnamed", "share_close", "interval_covers", "interval_off", "baseline_right"})
    CHECK_FALSE(figure({quiet}, id).target.empty());
}

TEST_CASE("Imperfect: a stated share is held against the true one of the same stage") {
  const auto with = [](double explains, const std::string& stage) {
    ReadReport report = reported("named", {"mass"});
    report.stages.front().stage = stage;
    report.stages.front().effects = {{"mass", "scale", 1.2, 1.1, 1.3, explains}};
    return scored(plan_of(Stratum::single, {kMass}), report);
  };
  // 0.8 is true of drive to body
  CHECK(figure({with(0.71, "drive to body")}, "share_close").value == 1);
  CHECK(figure({with(0.91, "drive to body")}, "share_close").value == 0);
  CHECK(figure({with(0.8, "command to drive")}, "share_close").cases == 0);
  CHECK(figure(times(9, with(0.8, "drive to body"), 1, with(0.6, "drive to body")), "share_close").met);
  CHECK_FALSE(figure(times(8, with(0.8, "drive to body"), 1, with(0.6, "drive to body")), "share_close").met);
  const auto json = nlohmann::json::parse(score_json({with(0.71, "drive to body")}));
  CHECK(json["cases"][0]["shares"][0]["truth"] == 0.8);
  CHECK(json["cases"][0]["shares"][0]["stated"] == 0.71);
}

TEST_CASE("Imperfect: the middle value is as far from the truth as intervals of 95 % say") {
  const auto with = [](double value, double from, double to) {
    ReadReport report = reported("named", {"mass"});
    report.stages.front().effects = {{"mass", "scale", value, from, to}};
    return scored(plan_of(Stratum::single, {kMass}), report);
  };
  // 1.2 is hidden: 0.035 of half widths of 0.1 off, and 0.05 of 0.1
  CHECK(figure({with(1.165, 1.065, 1.265)}, "interval_off").value == Approx(0.35));
  CHECK(figure({with(1.165, 1.065, 1.265)}, "interval_off").met);
  CHECK_FALSE(figure({with(1.15, 1.05, 1.25)}, "interval_off").met);
  CHECK_FALSE(figure({with(1.19, 1.09, 1.29)}, "interval_off").met);
  CHECK(figure({with(1.165, 1.065, 1.265)}, "interval_covers").cases == 1);
}

TEST_CASE("Imperfect: the key has the background, sizes and shares, and is read back as it was written") {
  CasePlan plan = plan_of(Stratum::pair, {kMass, kDelay});
  plan.manoeuvres = {"straight", "arc"};
  plan.longest_s = {5.5, 12.25};
  plan.repeats = 1;
  plan.count_scale = 0.7;
  const std::string text = key_text({17,
                                     {{plan, "data"},
                                      {plan_of(Stratum::foreign), ""},
                                      {plan_of(Stratum::withheld_number), ""},
                                      {plan_of(Stratum::baseline), ""},
                                      {plan_of(Stratum::baseline, {kMass}), ""}},
                                     ChallengeKind::imperfect});
  const ChallengeKey key = read_key(text);
  CHECK(key.kind == ChallengeKind::imperfect);
  const CasePlan& read = key.cases.at(0).plan;
  CHECK(read.background.floors == 4);
  REQUIRE(read.background.numbers.size() == 1);
  CHECK(read.background.numbers[0].key == "track.separation_m");
  CHECK(read.background.numbers[0].value == 0.203);
  CHECK(read.effects.at(1).times_background == 4);
  CHECK(read.effects.at(1).shares.at(0).stage == "drive to body");
  CHECK(read.effects.at(1).shares.at(0).share == 0.8);
  CHECK(read.longest_s == plan.longest_s);
  CHECK(read.count_scale == 0.7);
  CHECK(key.cases.at(1).plan.foreign_times_background == 4);
  CHECK(key.cases.at(2).plan.number.key == "drive.max_force_n");
  CHECK(key.cases.at(2).plan.number.value == 300);
  CHECK(key.cases.at(2).plan.number.floors == 16);
  CHECK(key.cases.at(2).plan.number.times_background == 4);
  CHECK(key.cases.at(3).plan.stratum == Stratum::baseline);
  CHECK(key_text(key) == text);

  const auto with = [](CasePlan other) { return key_text({17, {{std::move(other), ""}}, ChallengeKind::imperfect}); };
  CasePlan none = plan_of(Stratum::none);
  none.background.numbers = {{"track.separation_m", 0.01}};  // the belts would overlap
  CHECK_THROWS_WITH(read_key(with(none)), Catch::Contains("makes an invalid robot"));
  none.background.numbers = {{"track.colour", 1}};
  CHECK_THROWS_WITH(read_key(with(none)), Catch::Contains("track.colour"));
  CHECK_THROWS_WITH(read_key(with(plan_of(Stratum::baseline, {kMass, kDelay}))), Catch::Contains("its stratum"));
  CasePlan number = plan_of(Stratum::withheld_number);
  number.number.value = -1;
  CHECK_THROWS_WITH(read_key(with(number)), Catch::Contains("makes an invalid robot"));
  number.number.key.clear();
  CHECK_THROWS_WITH(read_key(with(number)), Catch::Contains("its stratum"));
  CasePlan cut = plan_of(Stratum::none);
  cut.manoeuvres = {"straight", "arc"};
  cut.longest_s = {5};
  CHECK_THROWS_WITH(read_key(with(cut)), Catch::Contains("the end time of each manoeuvre"));
}
