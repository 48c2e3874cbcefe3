#include "gap/diagnose/shares_of_effects.hpp"

#include <algorithm>
#include <utility>

#include "gap/diagnose/judgement.hpp"
#include "gap/diagnose/stage_data.hpp"
#include "gap/diagnose/substitutes.hpp"

namespace kenaf::gap::diagnose {
namespace {

// The model without each of these sets of its effects, the others at their values.
std::vector<Model> simulated_without(const Model& model, const Simulate& simulate,
                                     std::span<const std::vector<std::size_t>> sets) {
  std::vector<Model> without;
  std::vector<Settings> asked;
  for (const std::vector<std::size_t>& set : sets) {
    Model others = model;
    others.places.clear();
    for (std::size_t e = 0; e < model.places.size(); ++e)
      if (std::ranges::count(set, e) == 0) others.places.push_back(model.places[e]);
    asked.push_back(settings_of(others.places));
    without.push_back(std::move(others));
  }
  std::vector<GroupVectors> shifts = simulate(asked, Fidelity::every_run);
  for (std::size_t s = 0; s < without.size(); ++s) without[s].shift = std::move(shifts[s]);
  return without;
}

}  // namespace

SharesOfEffects shares_of_effects(const StageView& view, Passage passage, const StandingModel& best,
                                  const Simulate& simulate, const Folds& by_repeat, const Folds& by_manoeuvre,
                                  const DecisionSettings& settings) {
  const unsigned threads = settings.search.threads;
  std::vector<std::vector<std::size_t>> singles;
  for (std::size_t e = 0; e < best.model.places.size(); ++e) singles.push_back({e});
  const std::vector<Model> without_each = simulated_without(best.model, simulate, singles);
  SharesOfEffects shares{shares_held_out(view, passage, best, without_each, by_repeat, threads),
                         shares_held_out(view, passage, best, without_each, by_manoeuvre, threads)};

  // from curves, and again by simulation for those that would explain enough
  const auto of_sets = [&](std::span<const std::vector<std::size_t>> sets, const std::vector<Model>& without,
                           const Folds& folds) {
    return shares_of_sets_held_out(view, passage, best, sets, without, folds, threads);
  };
  std::vector<std::vector<std::size_t>> sets =
      sets_small_first(places_of_sets(shares.of_repeats, shares.of_manoeuvres, settings));
  if (sets.empty()) return shares;
  const Eigen::MatrixXd products =
      products_of_effects(stage_data(passage, *view.features, *view.repeats, *view.residuals, *view.floor), best);
  std::erase_if(
      sets, [&](const std::vector<std::size_t>& set) { return least_apart(products, set) > settings.apart_in_set; });
  shares.of_repeats.sets = of_sets(sets, {}, by_repeat);
  shares.of_manoeuvres.sets = of_sets(sets, {}, by_manoeuvre);
  std::vector<std::size_t> large;
  std::vector<std::vector<std::size_t>> large_sets;
  for (std::size_t s = 0; s < sets.size(); ++s) {
    if (shares.of_repeats.sets[s].share.of_stage < settings.stage_share) continue;
    large.push_back(s);
    large_sets.push_back(sets[s]);
  }
  const std::vector<Model> without_sets = simulated_without(best.model, simulate, large_sets);
  const auto of_repeats = of_sets(large_sets, without_sets, by_repeat),
             of_manoeuvres = of_sets(large_sets, without_sets, by_manoeuvre);
  for (std::size_t i = 0; i < large.size(); ++i) {
    shares.of_repeats.sets[large[i]] = of_repeats[i];
    shares.of_manoeuvres.sets[large[i]] = of_manoeuvres[i];
  }
  return shares;
}

}  // namespace kenaf::gap::diagnose
