// What the cases of a challenge are.
#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <set>

#include "gap/challenge/plan.hpp"
#include "physics/effects.hpp"

using namespace kenaf;
using gap::challenge::CasePlan;
using gap::challenge::plan_challenge;
using gap::challenge::Stratum;

namespace {

bool same(const CasePlan& a, const CasePlan& b) {
  const auto same_effect = [](const gap::challenge::HiddenEffect& x, const gap::challenge::HiddenEffect& y) {
    return x.effect == y.effect && x.parameter == y.parameter && x.floors == y.floors;
  };
  return a.name == b.name && a.stratum == b.stratum && a.foreign == b.foreign && a.foreign_floors == b.foreign_floors &&
         std::ranges::equal(a.effects, b.effects, same_effect) && a.manoeuvres == b.manoeuvres &&
         a.unseen == b.unseen && a.seed == b.seed && a.noise_scale == b.noise_scale &&
         a.noise_memory_s == b.noise_memory_s && a.physics.contact_stiffness_npm == b.physics.contact_stiffness_npm;
}

}  // namespace

TEST_CASE("The same seed plans the same challenge, another one another") {
  const auto one = plan_challenge(40, 7), again = plan_challenge(40, 7), other = plan_challenge(40, 8);
  REQUIRE(one.size() == 40);
  CHECK(std::ranges::equal(one, again, same));
  CHECK_FALSE(std::ranges::equal(one, other, same));
}

TEST_CASE("Of every number of cases at least three of ten hide nothing, and all strata are there") {
  for (const std::size_t cases : {20U, 150U, 151U, 500U}) {
    std::map<Stratum, double> count;
    for (const CasePlan& plan : plan_challenge(cases, 3)) ++count[plan.stratum];
    const auto share = [&](Stratum stratum) { return count[stratum] / static_cast<double>(cases); };
    CHECK(share(Stratum::none) >= 0.3);
    CHECK(share(Stratum::none) < 0.3 + 1.0 / static_cast<double>(cases));
    for (const Stratum stratum : {Stratum::single, Stratum::pair, Stratum::withheld, Stratum::foreign})
      CHECK(count[stratum] >= 1);
  }
}

TEST_CASE("The order of cases says nothing of what they hide") {
  const auto plans = plan_challenge(100, 4);
  std::size_t changes = 0;
  for (std::size_t i = 1; i < plans.size(); ++i) changes += plans[i].stratum != plans[i - 1].stratum;
  CHECK(changes > 50);  // sorted by stratum there would be 4
  for (std::size_t i = 0; i < plans.size(); ++i) CHECK(plans[i].name.size() == std::string("case-000").size());
}

TEST_CASE("Of 150 cases each effect of the catalogue is hidden alone in one, or withheld in one") {
  // Once in both strata would be 112 of the 150 cases, which leaves too few of the others. 26 % of 150 for each of the
  // two are 78 together: no fewer than the 53 effects that take turns, each of which has one before any has a second
  // one.
  std::map<std::string, std::size_t> hidden;
  for (const CasePlan& plan : plan_challenge(150, 5))
    if (plan.stratum != Stratum::pair)
      for (const gap::challenge::HiddenEffect& effect : plan.effects) ++hidden[effect.effect];
  for (const physics::EffectInfo& effect : physics::effect_catalogue()) {
    const bool is_chance = effect.name == "command_loss";  // has no size that could be made
    const std::size_t turns = hidden[std::string(effect.name)];
    if (is_chance)
      CHECK(turns == 0);
    else
      CHECK((turns == 1 || turns == 2));
  }
}

TEST_CASE("Each case hides what its stratum says, as large as it says, and differs from the model besides") {
  std::set<std::string> foreign;
  for (const gap::challenge::ForeignEffect& effect : gap::challenge::foreign_effects())
    foreign.insert(std::string(effect.name));
  double smallest = 10, largest = 0;
  for (const CasePlan& plan : plan_challenge(300, 6)) {
    const std::map<Stratum, std::size_t> effects{
        {Stratum::none, 0}, {Stratum::single, 1}, {Stratum::pair, 2}, {Stratum::withheld, 1}, {Stratum::foreign, 0}};
    CHECK(plan.effects.size() == effects.at(plan.stratum));
    CHECK(plan.foreign.empty() == (plan.stratum != Stratum::foreign));
    if (!plan.foreign.empty()) {
      CHECK(foreign.contains(plan.foreign));
      CHECK((plan.foreign_floors >= 2 && plan.foreign_floors <= 5));
    }
    for (const gap::challenge::HiddenEffect& hidden : plan.effects) {
      REQUIRE(physics::find_effect(hidden.effect) != nullptr);
      CHECK(physics::find_parameter(*physics::find_effect(hidden.effect), hidden.parameter) != nullptr);
      CHECK((hidden.floors >= (plan.stratum == Stratum::single ? 0.5 : 2) && hidden.floors <= 5));
      if (plan.stratum != Stratum::single) continue;
      smallest = std::min(smallest, hidden.floors);
      largest = std::max(largest, hidden.floors);
    }
    if (plan.effects.size() == 2) CHECK(plan.effects[0].effect != plan.effects[1].effect);
    CHECK(std::ranges::count(plan.manoeuvres, plan.unseen) == 0);
    CHECK(plan.physics.time_step_s != physics::PhysicsSettings{}.time_step_s);
    CHECK(plan.physics.contact_stiffness_npm != physics::PhysicsSettings{}.contact_stiffness_npm);
  }
  // 78 of them, evenly over a factor of ten by their logarithm
  CHECK(smallest < 0.7);
  CHECK(largest > 4);
}

TEST_CASE("No value is hidden that a model cannot have") {
  // Contacts half as stiff and with twice the damping of the model's, whose own ranges end at 50 and 20: half of that
  // is left.
  CasePlan plan;
  plan.physics.contact_stiffness_npm /= 2;
  plan.physics.contact_damping_nspm *= 2;
  const gap::challenge::HiddenEffect compliance{"ground_compliance", "scale", 3, 0},
      damping{"ground_damping", "scale", 3, 0}, mass{"mass", "scale", 3, 0};
  const auto furthest = [&](const gap::challenge::HiddenEffect& hidden, bool upward) {
    return furthest_value(plan, parameter_of(hidden), upward);
  };
  CHECK(furthest(compliance, true) == Approx(1 + 0.95 * (25 - 1)));
  CHECK(furthest(damping, true) == Approx(1 + 0.95 * (10 - 1)));
  // downward it is the robot's own range that ends first: 0.2 and 0.1
  CHECK(furthest(compliance, false) == Approx(1 - 0.95 * (1 - 0.2)));
  CHECK(furthest(damping, false) == Approx(1 - 0.95 * (1 - 0.1)));
  const auto& parameter = parameter_of(mass);
  CHECK(furthest(mass, true) == Approx(1 + 0.95 * (parameter.max - 1)));

  // twice as stiff: downward the model's range ends first, at 0.2 of its contacts, which are 0.4 of the robot's
  plan.physics.contact_stiffness_npm *= 4;
  CHECK(furthest(compliance, false) == Approx(1 - 0.95 * (1 - 0.4)));
  CHECK(furthest(compliance, true) == Approx(1 + 0.95 * (50 - 1)));
}
