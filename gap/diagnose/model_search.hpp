// Models of a gap, that is effects at fitted values, from curves to exact simulations.
//
// Cheap before dear: coarse curves rank all effects and all sets of them; the best ones get points where they
// fit best, then every run simulated.
// Thread safety: pure functions apart from what the simulator callbacks do.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <span>
#include <vector>

#include "gap/diagnose/coherence.hpp"
#include "gap/diagnose/curve_fit.hpp"
#include "gap/diagnose/effect_curves.hpp"

namespace kenaf::gap {

struct Model {
  std::vector<OnCurve> places;  // none: nominal
  Shift shift;                  // by all its effects together
  bool exact = false;           // every run was simulated with all effects at these values
  double left = 0;              // squared length of what it does not explain, of all runs, whitened
  double coherent = 0;          // energy of that
};
// Sets `left` and `coherent` with the whiteners that the curves have now.
void measure(Model& model, const EffectCurves& curves, const Coherence& coherence);

// What the search needs of the simulator.
struct Simulator {
  std::function<void(EffectCurves&, std::span<const NewPoint>, Fidelity)> add_points;
  // Shifts by effects together.
  std::function<std::vector<Shift>(std::span<const std::vector<NewPoint>>, Fidelity)> shifts;
  // Whiteners of the floor around a model.
  std::function<std::vector<Whitener>(std::span<const NewPoint>)> whiteners_around;
  // What the simulator's numbers shift in each run, in the same floor, as OpenShapes::numerics has them.
  std::function<std::vector<Eigen::MatrixXd>()> numerics{};
  // Squared length of what repeats differ by beyond what a model's shift says of their starts, in the same floor.
  std::function<double(const Shift&)> repeats_around{};
};

// Of the rms of what repeats differ by, so much may a model leave that explains a gap (chosen: docs/gap-method.md).
inline constexpr double kWithinRepeats = 1.25;

struct SearchSettings {
  std::size_t contenders = 8;   // single effects, and sets, that are refined, coarse
  std::size_t finalists = 5;    // of these, how many are refined by all runs
  int rounds = 5;               // at most, of refining, coarse
  int exact_rounds = 8;         // at most, of refining by all runs
  int together_rounds = 3;      // of refining sets, coarse and then by all runs
  double near = 0.1;            // share of what the best one explains by which a finalist may be worse
};

std::vector<NewPoint> values_of(const std::vector<OnCurve>& places);
// Curves of different effects that may explain a gap together.
using EffectSet = std::vector<std::size_t>;
EffectSet effects_of(const Model& model);
// By curves, of effects at these places together.
Shift shift_of(const EffectCurves& curves, std::span<const OnCurve> places);
Whitened whitened(const EffectCurves& curves, const Shift& shift);
Whitened whitened_difference(const EffectCurves& curves, const std::vector<Eigen::VectorXd>& a, const Shift& b);
// Inner products of all runs together.
Products products_of(const EffectCurves& curves, const Whitened& gap);

// Best first: finalists exact, all others as their curves have them.
std::vector<Model> search_singles(EffectCurves& curves, const Coherence& coherence, const Simulator& simulator,
                                  const SearchSettings& settings);

// Sets of effects that these runs show.
std::vector<EffectSet> all_pairs(const EffectCurves& curves);
std::vector<EffectSet> with_one_more(const EffectCurves& curves, const Model& model);
// Best first. Only sets that, by their curves, leave less than `to_beat` are simulated; no other one is returned.
std::vector<Model> search_sets(const EffectCurves& curves, const Coherence& coherence, const Simulator& simulator,
                               const SearchSettings& settings, std::vector<EffectSet> sets, double to_beat);

// `model` fitted again: what it had in simulation beyond the sum of its curves stays as it is.
std::vector<Products> products_of_runs_around(const EffectCurves& curves, const Model& model);
Products products_around(const EffectCurves& curves, const Model& model);  // of all runs together
// Squared length that is left when one effect of the model is taken out and the others are fitted again; by curves.
double left_without(const EffectCurves& curves, const Model& model, std::size_t place);

}  // namespace kenaf::gap
