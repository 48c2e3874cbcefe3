// What the cases of the imperfect challenge are.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <set>

#include "gap/candidates/candidate.hpp"
#include "gap/candidates/robot_numbers.hpp"
#include "gap/challenge/background.hpp"
#include "gap/challenge/case_runs.hpp"
#include "gap/challenge/key.hpp"
#include "gap/challenge/plan.hpp"
#include "gap/challenge/stand_ins.hpp"
#include "physics/effects.hpp"
#include "rollout/engines/body_in_engine.hpp"

using namespace kenaf;
using namespace kenaf::gap;
using namespace kenaf::gap::candidates;
using namespace kenaf::gap::challenge;

namespace {

std::vector<CasePlan> imperfect(std::size_t cases, std::uint64_t seed) {
  return plan_challenge(cases, seed, ChallengeKind::imperfect);
}

}  // namespace

TEST_CASE("A background moves every number of the description, by at most 3 %, and makes a robot") {
  const physics::RobotDescription robot = physics::load_robot(kChallengedRobot);
  const std::vector<Candidate> candidates = description_candidates(robot);
  double furthest = 0;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const Background background = draw_background(robot, seed, {});
    // all but the belly's length, which the track's moves
    CHECK(background.numbers.size() == candidates.size() - 1);
    CHECK(why_impossible(with_background(robot, background)).empty());
    for (const BackgroundNumber& number : background.numbers) {
      INFO(number.key);
      const auto candidate = std::ranges::find(candidates, number.key, &Candidate::name);
      REQUIRE(candidate != candidates.end());
      const double whole = candidate->present != 0 ? candidate->present : candidate->max - candidate->min;
      const double off = std::abs(number.value - candidate->present) / std::abs(whole);
      CHECK(off <= 0.03 + 1e-12);
      CHECK((number.value >= candidate->min && number.value <= candidate->max));
      CHECK(
          find_robot_number(with_background(robot, background), number.key)->get(with_background(robot, background)) ==
          Approx(number.value));
      furthest = std::max(furthest, off);
    }
  }
  CHECK(furthest > 0.029);
  const Background one = draw_background(robot, 7, {}), again = draw_background(robot, 7, {}),
                   without = draw_background(robot, 7, std::vector<std::string>{"body.mass_kg"});
  REQUIRE(one.numbers.size() == again.numbers.size());
  CHECK(without.numbers.size() == one.numbers.size() - 1);
  for (std::size_t i = 0; i < one.numbers.size(); ++i) CHECK(one.numbers[i].value == again.numbers[i].value);
  // leaving one out leaves the others as they were
  CHECK(without.numbers.back().value == one.numbers.back().value);
}

TEST_CASE("No number that does what is hidden is in the background, so that the hidden value is the true one") {
  CHECK(numbers_like("mass") == std::vector<std::string>{"body.mass_kg"});
  CHECK(numbers_like("drive_lag") == std::vector<std::string>{"drive.time_constant_s"});
  CHECK(numbers_like("command_delay").empty());
  for (const CasePlan& plan : imperfect(60, 2))
    for (const HiddenEffect& hidden : plan.effects)
      for (const std::string& key : numbers_like(hidden.effect))
        CHECK(std::ranges::count(plan.background.numbers, key, &BackgroundNumber::key) == 0);
}

TEST_CASE("What stands in for a withheld effect is withheld with it") {
  CasePlan plan;
  plan.stratum = Stratum::withheld;
  plan.effects = {{"drive_lag", "lag_s"}};
  CHECK(withheld_names(plan) == std::vector<std::string>{"drive_lag", "drive.time_constant_s"});
  plan.effects = {{"tracking_delay", "delay_s"}};
  CHECK(withheld_names(plan) == std::vector<std::string>{"tracking_delay", "clock_offset"});
  plan.effects = {{"drive_coulomb", "force_n"}};
  CHECK(withheld_names(plan) == std::vector<std::string>{"drive_coulomb", "drive_coulomb_left", "drive_coulomb_right"});
  plan.effects = {{"mass", "scale"}};  // the diagnosis itself leaves out body.mass_kg then
  CHECK(withheld_names(plan) == std::vector<std::string>{"mass"});
  plan.stratum = Stratum::single;
  CHECK(withheld_names(plan).empty());
  plan.stratum = Stratum::withheld_number;
  plan.effects.clear();
  plan.number.key = "drive.max_force_n";
  CHECK(withheld_names(plan) == std::vector<std::string>{"drive.max_force_n"});
}

TEST_CASE("A pair is of two effects that could be told apart") {
  CHECK(stand_in_for_each_other("tracking_delay", "clock_offset"));
  CHECK(stand_in_for_each_other("drive.time_constant_s", "drive_lag"));
  CHECK_FALSE(stand_in_for_each_other("drive_lag", "command_slew"));
  CHECK_FALSE(stand_in_for_each_other("drive_lag", "drive_lag"));
  // the order of turns of this seed would pair the first two
  for (const CasePlan& plan : imperfect(60, 131))
    if (plan.stratum == Stratum::pair)
      CHECK_FALSE(stand_in_for_each_other(plan.effects[0].effect, plan.effects[1].effect));
}

TEST_CASE("Every name that is withheld is a candidate of the diagnosis") {
  const physics::RobotDescription robot = physics::load_robot(kChallengedRobot);
  std::set<std::string> names;
  for (const Candidate& candidate : catalogue_candidates(robot, true)) names.insert(candidate.effect);
  for (const Candidate& candidate : description_candidates(robot)) names.insert(candidate.effect);
  for (const physics::EffectInfo& effect : physics::effect_catalogue()) {
    if (effect.name == "command_loss") continue;
    CasePlan plan;
    plan.stratum = Stratum::withheld;
    plan.effects = {{std::string(effect.name), std::string(effect.parameters.front().name)}};
    for (const std::string& name : withheld_names(plan)) CHECK(names.contains(name));
  }
}

TEST_CASE("A number that is withheld is one that no effect stands in for, and is in no background but as hidden") {
  const std::vector<std::string> keys = numbers_like_nothing_else();
  CHECK(keys.size() > 20);
  for (const std::string& key : keys) {
    INFO(key);
    CHECK(same_effect(key) == key);
    for (const physics::EffectInfo& effect : physics::effect_catalogue())
      CHECK(std::ranges::count(numbers_like(effect.name), key) == 0);
  }
  CHECK(std::ranges::count(keys, "body.mass_kg") == 0);
  CHECK(std::ranges::count(keys, "drive.time_constant_s") == 0);

  std::size_t hidden = 0;
  for (CasePlan& plan : imperfect(200, 6)) {
    CHECK(plan.number.key.empty() == (plan.stratum != Stratum::withheld_number));
    if (plan.number.key.empty()) continue;
    ++hidden;
    INFO(plan.number.key);
    CHECK(std::ranges::count(keys, plan.number.key) == 1);
    CHECK((plan.number.times_background >= 1 && plan.number.times_background <= 6));
    CHECK(std::ranges::count(plan.background.numbers, plan.number.key, &BackgroundNumber::key) == 0);
    for (const bool upward : {false, true}) {
      plan.number.value = furthest_value_of_number(plan, upward);
      const physics::RobotDescription robot = hidden_robot(plan);  // throws where it is none
      CHECK(find_robot_number(robot, plan.number.key)->get(robot) == Approx(plan.number.value));
    }
  }
  CHECK(hidden == 12);
}

TEST_CASE(
    "Since a baseline nothing or one effect has changed, of a size in floors, and before there was only background") {
  std::size_t nothing = 0, all = 0;
  for (CasePlan& plan : imperfect(300, 6)) {
    if (plan.stratum != Stratum::baseline) continue;
    ++all;
    nothing += plan.effects.empty();
    if (plan.effects.empty()) continue;
    REQUIRE(plan.effects.size() == 1);
    HiddenEffect& hidden = plan.effects.front();
    CHECK((hidden.floors >= 3 && hidden.floors <= 10));
    hidden.value = furthest_value(plan, parameter_of(hidden), true);
    CHECK(robot_before(plan).effects.*parameter_of(hidden).value == parameter_of(hidden).neutral);
    CHECK(hidden_robot(plan).effects.*parameter_of(hidden).value == hidden.value);
  }
  CHECK(all == 30);
  CHECK((nothing >= 2 && nothing <= 17));  // 9 by chance: three standard deviations are 7.5
}

TEST_CASE("Imperfect: strata have the shares that are documented") {
  std::map<Stratum, std::size_t> count;
  const auto plans = imperfect(200, 3);
  for (const CasePlan& plan : plans) ++count[plan.stratum];
  CHECK(count[Stratum::none] == 48);
  CHECK(count[Stratum::single] == 60);
  CHECK(count[Stratum::pair] == 26);
  CHECK(count[Stratum::withheld] == 20);
  CHECK(count[Stratum::foreign] == 14);
  CHECK(count[Stratum::withheld_number] == 12);
  CHECK(count[Stratum::baseline] == 20);
}

TEST_CASE(
    "Imperfect: every case has a background, counts and coloured noise, and short runs of which half are repeated") {
  std::size_t repeated = 0;
  double smallest = 10, largest = 0;
  const auto plans = imperfect(200, 4);
  for (const CasePlan& plan : plans) {
    CHECK(plan.is_imperfect());
    CHECK(plan.noise_memory_s > 0);
    CHECK((plan.count_scale >= 0.5 && plan.count_scale <= 2));
    CHECK(plan.physics.time_step_s == physics::PhysicsSettings{}.time_step_s / 2);
    CHECK(std::ranges::count(plan.manoeuvres, plan.unseen) == 0);
    const std::set<std::string> different(plan.manoeuvres.begin(), plan.manoeuvres.end());
    CHECK(different.size() == plan.manoeuvres.size());
    const std::size_t count = plan.manoeuvres.size();
    if (plan.repeats == 2) {
      ++repeated;
      CHECK((count >= 3 && count <= 4));
    } else {
      CHECK(plan.repeats == 1);
      CHECK((count >= 5 && count <= 8));
    }
    REQUIRE(plan.longest_s.size() == count);
    for (const double longest_s : plan.longest_s) CHECK((longest_s >= 3 && longest_s <= 7));
    for (const HiddenEffect& hidden : plan.effects) {
      if (plan.stratum == Stratum::baseline) continue;
      CHECK((hidden.times_background >= (plan.stratum == Stratum::pair ? 3 : 1) && hidden.times_background <= 6));
      smallest = std::min(smallest, hidden.times_background);
      largest = std::max(largest, hidden.times_background);
    }
    if (plan.stratum == Stratum::foreign)
      CHECK((plan.foreign_times_background >= 1 && plan.foreign_times_background <= 6));
    for (const CaseRuns& runs : runs_to_choose_from(plan)) {
      CHECK(runs.longest_s.size() == runs.manoeuvres.size());
      CHECK((runs.manoeuvres.size() > 4) == (plan.repeats == 1));
    }
    CHECK(runs_to_choose_from(plan).size() == 5);
  }
  // of 200 by chance: three standard deviations are 21
  CHECK((repeated > 79 && repeated < 121));
  CHECK(smallest < 1.2);
  CHECK(largest > 5.8);
}

TEST_CASE("Imperfect: the same seed plans the same challenge, to the last number of the background") {
  const auto one = imperfect(20, 7), again = imperfect(20, 7), other = imperfect(20, 8);
  const auto same = [](const CasePlan& a, const CasePlan& b) {
    return a.stratum == b.stratum && a.manoeuvres == b.manoeuvres && a.longest_s == b.longest_s &&
           a.count_scale == b.count_scale && a.seed == b.seed &&
           std::ranges::equal(a.background.numbers, b.background.numbers,
                              [](const BackgroundNumber& x, const BackgroundNumber& y) {
                                return x.key == y.key && x.value == y.value;
                              });
  };
  CHECK(std::ranges::equal(one, again, same));
  CHECK_FALSE(std::ranges::equal(one, other, same));
}

TEST_CASE("Of 150 imperfect cases each effect of the catalogue is hidden alone or withheld in one") {
  // 40 % of 150 are 60: no fewer than the 53 effects that take turns
  std::set<std::string> hidden;
  for (const CasePlan& plan : imperfect(150, 5))
    if (plan.stratum == Stratum::single || plan.stratum == Stratum::withheld)
      for (const HiddenEffect& effect : plan.effects) hidden.insert(effect.effect);
  CHECK(hidden.size() == physics::effect_catalogue().size() - 1);  // all but command_loss
}

TEST_CASE("Where another engine moves the bodies, nothing is hidden that it would not show, and no run turns") {
  for (const CasePlan& plan : plan_challenge(300, 3, ChallengeKind::mujoco)) {
    CHECK(plan.is_imperfect());
    CHECK(plan.engine == "mujoco");
    for (const HiddenEffect& hidden : plan.effects)
      CHECK(engines::shows_in_engine(*physics::find_effect(hidden.effect)));
    for (const CaseRuns& runs : runs_to_choose_from(plan))
      for (const char* turning : {"turn-in-place", "square", "arc", "random-speeds"})
        CHECK(std::ranges::count(runs.manoeuvres, turning) == 0);
  }
  for (const CasePlan& plan : imperfect(20, 3)) CHECK(plan.engine.empty());
}

TEST_CASE("A key says which engine moved the bodies of its cases") {
  const CasePlan plan = plan_challenge(4, 3, ChallengeKind::ode).front();
  const ChallengeKey key = read_key(key_text({3, {{plan, ""}}, ChallengeKind::ode}));
  CHECK(key.kind == ChallengeKind::ode);
  CHECK(key.cases.at(0).plan.engine == "ode");
}
