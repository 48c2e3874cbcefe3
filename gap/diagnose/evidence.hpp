// How sure the values of a model are, and what it is worth on runs that it was not fitted to.
// Thread safety: values and pure functions; deterministic for a seed.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
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
// Runs dealt out in turn, manoeuvre by manoeuvre, to as many folds as the most repeated one has runs, at most five: repeats
// of a manoeuvre are in different folds. Where nothing is repeated, to as many folds as there are manoeuvres, at most five.
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
// `after`: what a model leaves of each run; intervals from resampling groups of repeats. `repeats_rest`: what repeats differ by,
// of each run, empty without repeats.
GapMeasure measure_gap(const StageView& view, const std::vector<Eigen::VectorXd>& after,
                       const std::vector<Eigen::VectorXd>& deviations, std::uint64_t seed);

// The places of a model fitted without the runs of each fold, for every run those of its fold. A single fold holds nothing out.
std::vector<std::vector<OnCurve>> places_held_out(const StageView& view, Passage passage, const StandingModel& standing,
                                                  const Folds& folds, unsigned threads);

// The share of the squared gap that each effect of a model takes off, by curves, on runs held out: of the model with it less of
// the model without it, fitted again. One entry for each effect, then the whole model.
std::vector<double> shares_held_out(const StageView& view, Passage passage, const StandingModel& standing,
                                    const Folds& folds, unsigned threads);

}  // namespace kenaf::gap
