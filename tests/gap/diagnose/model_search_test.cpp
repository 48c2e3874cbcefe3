// From curves to exact models.
#include "gap/diagnose/model_search.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "tests/gap/diagnose/linear_world.hpp"

using namespace kenaf;
using namespace kenaf::gap;
using namespace kenaf::gap::diagnose;
using test::LinearWorld;
using test::Whole;
using test::world;

namespace {

std::vector<Whole> six_effects() {
  std::vector<Whole> effects;
  for (Eigen::Index i = 0; i < 6; ++i) effects.push_back(60 * world().direction(i));
  return effects;
}

std::vector<Model> pairs_found(const LinearWorld::Moved& moved, const Whole& gap) {
  const StageData data = world().data(gap);
  EffectCurves curves = world().curves(moved, 6, data);
  return search_sets(data, curves, nominal_model(data), 0, world().simulate(moved), {}, all_pairs(curves));
}

double value_of(const Model& model, std::size_t effect) {
  for (const OnCurve& place : model.places)
    if (place.curve == effect) return place.value;
  return 0;
}

}  // namespace

TEST_CASE("A fit does not hang on discrepancies that take up what the effect does") {
  // an effect of 100 in the tracks and 3 in the battery; measured is half of it in the tracks, and in the battery 3 the
  // other way. Beneath a discrepancy of the tracks that is as large as the gap the battery says that there is no effect
  const Whole track = world().in_channel(test::WorldChannel::track, 100),
              battery = world().in_channel(test::WorldChannel::battery, 3);
  const StageData data = world().data(0.5 * track - battery + world().noise(1));
  const EffectCurves curves = world().curves({track + battery}, data);
  Discrepancies held = no_discrepancy();
  held.of_kind[kind_of(data.groups[0].bins[0].channel)] = {50, 16};
  const EffectSet effect{0};
  CHECK(value_of(fit_model(data, curves, effect, {}, held), 0) == Approx(0.5).margin(0.03));
}

TEST_CASE("A model is fitted with the discrepancies that suit what it leaves") {
  const std::vector<Whole> effects = six_effects();
  const StageData data = world().data(0.4 * effects[2]);
  const EffectCurves curves = world().curves(effects, data);
  const std::vector<std::size_t> right{2}, wrong{3};
  const Model model = fit_model(data, curves, right, {}, no_discrepancy());
  CHECK(model.places.at(0).value == Approx(0.4));
  CHECK(length_in_noise(data, rest_of(data, model)) < 1e-6);
  for (const Discrepancy& discrepancy : model.likelihood.discrepancies.of_kind) CHECK(discrepancy.sigma == 0);
  const Model other = fit_model(data, curves, wrong, {}, no_discrepancy());
  CHECK(length_in_noise(data, rest_of(data, other)) == Approx(24).margin(0.5));
  CHECK(
      std::ranges::any_of(other.likelihood.discrepancies.of_kind, [](const Discrepancy& d) { return d.sigma > 0.5; }));
  CHECK(other.deviance() > model.deviance() + 16);
  // what a simulation has beyond the curves is no part of what they are fitted to
  const GroupVectors beyond = world().by_group(0.1 * effects[2]);
  CHECK(fit_model(data, curves, right, beyond, no_discrepancy()).places.at(0).value == Approx(0.3));
}

TEST_CASE("Exact simulations correct what coarse ones said of an effect's size, anywhere in its range") {
  const std::vector<Whole> effects = six_effects();
  for (const double rough : {0.8, 1.25})
    for (const double value : {-0.9, -0.3, 0.2, 0.6, 0.75, 0.95}) {
      INFO("coarse simulations say " << rough << " times as much of " << value);
      const StageData data = world().data(value * effects[3] + world().noise(1));
      EffectCurves curves = world().curves(effects, data, rough);
      const std::vector<Model> singles =
          search_singles(data, curves, no_discrepancy(), world().simulate(LinearWorld::linear(effects), rough), {});
      REQUIRE(!singles.empty());
      CHECK(singles[0].exact);
      REQUIRE(singles[0].places.at(0).curve == 3);
      CHECK(singles[0].places[0].value == Approx(value).margin(4.0 / 60));  // its sigma is 1 / 60
      CHECK(std::ranges::is_sorted(singles, {}, &Model::deviance));
    }
}

TEST_CASE("Single effects that gain next to nothing on their curves are not simulated again") {
  const std::vector<Whole> effects = six_effects();
  const Simulate counted = world().simulate(LinearWorld::linear(effects));
  for (const auto& [length, is_worth_it] : {std::pair{3.0, false}, {4.5, true}}) {  // it gains the square of that
    std::size_t simulated = 0;
    const Simulate simulate = [&](std::span<const Settings> asked, Fidelity fidelity) {
      simulated += asked.size();
      return counted(asked, fidelity);
    };
    const StageData data = world().data(length / 60 * effects[3]);
    EffectCurves curves = world().curves(effects, data);
    const std::vector<Model> singles = search_singles(data, curves, no_discrepancy(), simulate, {});
    CHECK(singles.size() == 6);
    CHECK(singles[0].places.at(0).curve == 3);
    CHECK(singles[0].exact == is_worth_it);
    CHECK((simulated > 0) == is_worth_it);
  }
}

TEST_CASE("Effects that these runs do not show are in no set") {
  std::vector<Whole> effects = six_effects();
  effects[1] *= 0.9 / 60;  // less than noise at the end of its range
  const StageData data = world().data(Whole::Zero(world().bins()));
  const EffectCurves curves = world().curves(effects, data);
  const std::vector<EffectSet> pairs = all_pairs(curves);
  CHECK(pairs.size() == 10);  // of five
  CHECK(std::ranges::none_of(pairs, [](const EffectSet& set) { return std::ranges::count(set, 1u) > 0; }));
  CHECK(with_one_more(curves, {0, 2}) == std::vector<EffectSet>{{0, 2, 3}, {0, 2, 4}, {0, 2, 5}});
}

TEST_CASE("Of all pairs the two that are there are found, simulated at the full rate") {
  const std::vector<Whole> effects = six_effects();
  const std::vector<Model> found =
      pairs_found(LinearWorld::linear(effects), 0.5 * effects[1] - 0.4 * effects[4] + world().noise(1));
  REQUIRE(!found.empty());
  CHECK(found[0].exact);
  CHECK(effects_of(found[0]) == EffectSet{1, 4});
  CHECK(value_of(found[0], 1) == Approx(0.5).margin(4.0 / 60));
  CHECK(value_of(found[0], 4) == Approx(-0.4).margin(4.0 / 60));
}

TEST_CASE("Effects that change what the other one does are found together") {
  // beside a half of effect 4, effect 1 does 1.5 times what it does alone
  const std::vector<Whole> effects = six_effects();
  const auto moved = [&](const Settings& settings) {
    double one = 0, four = 0;
    for (const Setting& setting : settings) {
      if (setting.candidate == 1) one = setting.value;
      if (setting.candidate == 4) four = setting.value;
    }
    return Whole(LinearWorld::linear(effects)(settings) + one * four * effects[1]);
  };
  const std::vector<Model> found = pairs_found(moved, moved({{1, 0.4}, {4, 0.5}}) + world().noise(2));
  REQUIRE(!found.empty());
  CHECK(effects_of(found[0]) == EffectSet{1, 4});
  // where the sum of both alone would have it, 0.6, it is not
  CHECK(value_of(found[0], 1) == Approx(0.4).margin(0.1));
  CHECK(value_of(found[0], 4) == Approx(0.5).margin(0.1));
}

TEST_CASE("An effect is found together with others that act on each other, though their curves do not add up to them") {
  // beside a half of effect 4, effect 1 moves what no curve does, and hides effect 2
  const std::vector<Whole> effects = six_effects();
  const auto moved = [&](const Settings& settings) {
    double one = 0, four = 0;
    for (const Setting& setting : settings) {
      if (setting.candidate == 1) one = setting.value;
      if (setting.candidate == 4) four = setting.value;
    }
    return Whole(LinearWorld::linear(effects)(settings) + 4 * one * four * (60 * world().direction(7) - effects[2]));
  };
  const StageData data = world().data(moved({{1, 0.5}, {4, 0.5}, {2, 0.3}}) + world().noise(2));
  EffectCurves curves = world().curves(moved, 6, data);
  const Simulate simulate = world().simulate(moved);
  const Model than = search_sets(data, curves, nominal_model(data), 0, simulate, {}, {{1, 4}}).at(0);
  const std::vector<Model> found = search_sets(data, curves, than, 0, simulate, {}, with_one_more(curves, {1, 4}));
  REQUIRE(!found.empty());
  CHECK(effects_of(found[0]) == EffectSet{1, 4, 2});
  CHECK(value_of(found[0], 2) == Approx(0.3).margin(0.1));
}

TEST_CASE("An effect of which no more than a first look is known is found beyond that, together with another one") {
  const std::vector<Whole> effects = six_effects();
  const StageData data = world().data(0.9 * effects[1] + 0.8 * effects[4] + world().noise(2));
  const Simulate simulate = world().simulate(LinearWorld::linear(effects));
  EffectCurves curves = world().curves(effects, data);
  const std::vector<std::size_t> whole{0, 1, 2, 3, 5};
  forget_all_but(curves, whole);
  add_points(curves, data, std::vector<Setting>{{4, -0.25}, {4, 0.25}}, Fidelity::coarse, simulate);
  const std::vector<Model> found = search_sets(data, curves, nominal_model(data), 0, simulate, {}, all_pairs(curves));
  REQUIRE(!found.empty());
  REQUIRE(effects_of(found[0]) == EffectSet{1, 4});
  CHECK(value_of(found[0], 4) == Approx(0.8).margin(0.1));
}
