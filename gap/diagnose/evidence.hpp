// How sure the values of a model are, and what it is worth on runs that it was not fitted to.
// Thread safety: values and pure functions; deterministic for a seed.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "gap/diagnose/gap_size.hpp"
#include "gap/diagnose/side_by_side.hpp"

namespace kenaf::gap {

struct Interval {
  double value = 0, from = 0, to = 0;  // 95 %
};

// The value of one effect: a mean, and how far it differs from manoeuvre to manoeuvre.
struct EffectValue {
  Interval value;
  // Standard deviation between manoeuvres beyond what noise and discrepancy explain (a random effect, DerSimonian and
  // Laird 1986); 0 where they agree.
  double spread = 0;
  double p_agree = 1;  // chance that manoeuvres that agree differ as much (Cochran's Q)
};
// Of each effect of a model that stands. Intervals hold the parameter's range.
std::vector<EffectValue> effect_values(const StageData& data, const StandingModel& standing);

// Runs that are held out together: each run once.
using Folds = std::vector<std::vector<std::size_t>>;
// Runs dealt out in turn, manoeuvre by manoeuvre, to as many folds as the most repeated one has runs, at most five:
// repeats of a manoeuvre are in different folds. Where nothing is repeated, to as many folds as there are manoeuvres,
// at most five.
Folds folds_by_repeat(const std::vector<std::vector<std::size_t>>& repeats);
// All repeats of a manoeuvre together, dealt out to at most five folds.
Folds folds_by_manoeuvre(const Observations& observations);

// What a stage is measured with.
struct StageView {
  const std::vector<StageFeatures>* features;
  const std::vector<std::vector<std::size_t>>* repeats;
  const std::vector<Eigen::VectorXd>* residuals;  // of each run
  const NoiseFloor* floor;
};

// The gap on runs held out of the fit, in units of noise. NaN: not measured.
struct GapMeasure {
  static constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();
  double before = kNotMeasured, after = kNotMeasured, floor = kNotMeasured;
  Interval shrink{kNotMeasured, kNotMeasured, kNotMeasured};
  Interval explains{kNotMeasured, kNotMeasured, kNotMeasured};
};
// `after`: what a model leaves of each run; intervals from resampling groups of repeats. `repeats_rest`: what repeats
// differ by, of each run, empty without repeats.
GapMeasure measure_gap(const StageView& view, const std::vector<Eigen::VectorXd>& after,
                       const std::vector<Eigen::VectorXd>& deviations, std::uint64_t seed);

// The places of a model fitted without the runs of each fold, for every run those of its fold. A single fold holds
// nothing out.
std::vector<std::vector<OnCurve>> places_held_out(const StageView& view, Passage passage, const StandingModel& standing,
                                                  const Folds& folds, unsigned threads);

// Shares of the squared gap that a model takes off, each of its effects and sets of them: with them, less without them
// and the others fitted again. By curves, on runs held out; at most 1.
struct HeldOutShares {
  // Of the kind of channels in which the effect takes off most, and of the stage.
  struct OfEffect {
    double of_stage = 0, of_kind = 0;
    std::size_t kind = 0;
    double model_of_kind = 0;  // what the whole model takes off there
    // Deviance that the effect should take off the runs that are fitted to, if the model is right; of the fold where it
    // is least. Little: only the runs held out show the effect, and no others can foretell it.
    double shown_by_others = 0;
  };
  std::vector<OfEffect> effects;  // in the order of the model's places
  // What several effects take off together, which none of them may do alone, as each takes up what the others leave.
  struct OfSet {
    std::vector<std::size_t> places;  // two or more, ascending
    OfEffect share;
  };
  std::vector<OfSet> sets;  // those of interest, small ones first; shares_of_sets_held_out()
  double model = 0;  // of the stage
};
HeldOutShares shares_held_out(const StageView& view, Passage passage, const StandingModel& standing, const Folds& folds,
                              unsigned threads);

// Every set of two and more of these places: as many fits of each fold as there are sets.
std::vector<HeldOutShares::OfSet> shares_of_sets_held_out(const StageView& view, Passage passage,
                                                          const StandingModel& standing, const Folds& folds,
                                                          std::span<const std::size_t> places, unsigned threads);

}  // namespace kenaf::gap
