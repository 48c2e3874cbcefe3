// Models of a stage's gap, that is effects at fitted values, from curves to exact simulations.
//
// Cheap before dear: coarse curves rank all effects and sets of them; the best ones get points where they fit best,
// then one run of each group at the full rate. Models are compared by their deviance, each with the discrepancies that
// suit it best.
//
// Thread safety: pure functions apart from what the simulator does.
#pragma once

#include <span>
#include <vector>

#include "gap/diagnose/curve_fit.hpp"
#include "gap/diagnose/effect_curves.hpp"
#include "gap/diagnose/likelihood.hpp"

namespace kenaf::gap::diagnose {

struct Model {
  std::vector<OnCurve> places;  // none: nominal
  GroupVectors shift;           // by all its effects together
  bool exact = false;           // was simulated at the full rate with all effects at these values
  Likelihood likelihood;
  double deviance() const { return likelihood.deviance; }
};

struct SearchSettings {
  std::size_t first_sets = 24;  // that are fitted with discrepancies of their own
  std::size_t contenders = 8;   // single effects, and sets, that are refined, coarse
  std::size_t finalists = 4;    // of these, how many are refined at the full rate
  int rounds = 2;               // of refining, coarse
  int exact_rounds = 4;         // at most, of refining at the full rate
  double near = 0.1;            // share of what the best one's deviance gains by which a finalist may be worse
  double worth = 12;  // deviance that a single effect must gain on its curve to be refined: near what a name asks for
  unsigned threads = 0;
};

Model nominal_model(const StageData& data);
GroupVectors residuals_of(const StageData& data);
// As it simulates at `settings`, every run. `like`: another model, with whose discrepancies the estimate begins.
Model simulated_model(const StageData& data, const EffectCurves& curves, const Simulate& simulate,
                      const Settings& settings, const Model& like);
// What a model leaves of each group.
GroupVectors rest_of(const StageData& data, const Model& model);
bool has_effect(const Model& model, std::size_t candidate);

using EffectSet = std::vector<std::size_t>;  // numbers of candidates
EffectSet effects_of(const Model& model);

// Fitted on the curves; `beyond`: what the effects together shift beyond the sum of their curves, of each group; empty:
// nothing. Discrepancies are estimated from `start` on, and from none: the likelier fit of both.
Model fit_model(const StageData& data, const EffectCurves& curves, std::span<const std::size_t> effects,
                const GroupVectors& beyond, const Discrepancies& start);
// The same with given discrepancies, which stay as they are.
Model fit_values(const StageData& data, const EffectCurves& curves, std::span<const std::size_t> effects,
                 const GroupVectors& beyond, const Discrepancies& discrepancies);
// What a simulated model shifts beyond the sum of its curves.
GroupVectors beyond_curves(const EffectCurves& curves, const Model& model);

// Best first; finalists that are worth it exact, all others as their curves have them.
std::vector<Model> search_singles(const StageData& data, EffectCurves& curves, const Discrepancies& start,
                                  const Simulate& simulate, const SearchSettings& settings);

// Sets of effects that these runs show.
std::vector<EffectSet> all_pairs(const EffectCurves& curves);
std::vector<EffectSet> with_one_more(const EffectCurves& curves, const EffectSet& set);
// Those whose deviance is less than that of `than` by `by`, best first; only sets that were simulated at the full rate.
// What `than` shifts beyond the sum of its curves is taken to be so in the sets, too, until they are simulated. Curves
// that end before an effect's range does where one of the first sets fits best are followed to its ends.
std::vector<Model> search_sets(const StageData& data, EffectCurves& curves, const Model& than, double by,
                               const Simulate& simulate, const SearchSettings& settings, std::vector<EffectSet> sets);

}  // namespace kenaf::gap::diagnose
