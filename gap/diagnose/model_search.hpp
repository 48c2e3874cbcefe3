// Search for models of a stage's gap, i.e. sets of effects with fitted values, from curves to exact simulations.
//
// Coarse to fine: coarse curves rank all effects and sets of them; the best ones get points at their optimum, then one
// run of each group at the full rate. Models are compared by their deviance, each with its own best discrepancies.
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
  GroupVectors shift;           // of all effects together
  bool exact = false;           // simulated at the full rate with all effects at these values
  Likelihood likelihood;
  double deviance() const { return likelihood.deviance; }
};

struct SearchSettings {
  std::size_t first_sets = 24;  // sets fitted with discrepancies of their own
  std::size_t contenders = 8;   // single effects, and sets, that are refined with coarse simulations
  std::size_t finalists = 4;    // of these, how many are refined at the full rate
  int rounds = 2;               // of coarse refinement
  int exact_rounds = 4;         // at most, of refinement at the full rate
  double near = 0.1;            // tolerance of a finalist's deviance, as a fraction of the best one's gain
  double worth = 12;            // deviance gain of a single effect on its curve to be refined: close to that for a name
  unsigned threads = 0;
};

Model nominal_model(const StageData& data);
GroupVectors residuals_of(const StageData& data);
// Simulates every run at `settings`. `like`: a model whose discrepancies start the estimate.
Model simulated_model(const StageData& data, const EffectCurves& curves, const Simulate& simulate,
                      const Settings& settings, const Model& like);
// The residual of a model for each group.
GroupVectors rest_of(const StageData& data, const Model& model);
bool has_effect(const Model& model, std::size_t candidate);

using EffectSet = std::vector<std::size_t>;  // numbers of candidates
EffectSet effects_of(const Model& model);

// Fits on the curves. `beyond`: joint shift of the effects minus the sum of their curves, for each group; empty: none.
// Estimates discrepancies starting from `start` and from none, and returns the more likely fit.
Model fit_model(const StageData& data, const EffectCurves& curves, std::span<const std::size_t> effects,
                const GroupVectors& beyond, const Discrepancies& start);
// The same with fixed discrepancies.
Model fit_values(const StageData& data, const EffectCurves& curves, std::span<const std::size_t> effects,
                 const GroupVectors& beyond, const Discrepancies& discrepancies);
// The shift of a simulated model minus the sum of its curves.
GroupVectors beyond_curves(const EffectCurves& curves, const Model& model);

// Best first; finalists that are worth it are simulated at the full rate, all others are taken from their curves.
std::vector<Model> search_singles(const StageData& data, EffectCurves& curves, const Discrepancies& start,
                                  const Simulate& simulate, const SearchSettings& settings);

// Sets of effects that are visible in these runs.
std::vector<EffectSet> all_pairs(const EffectCurves& curves);
std::vector<EffectSet> with_one_more(const EffectCurves& curves, const EffectSet& set);
// Returns the sets whose deviance is at least `by` below that of `than`, best first; all simulated at the full rate.
// Until a set is simulated, it is assumed to have the same interaction (shift minus sum of curves) as `than`. Extends
// curves to the ends of the range if one of the first sets fits best at a premature end.
std::vector<Model> search_sets(const StageData& data, EffectCurves& curves, const Model& than, double by,
                               const Simulate& simulate, const SearchSettings& settings, std::vector<EffectSet> sets);

}  // namespace kenaf::gap::diagnose
