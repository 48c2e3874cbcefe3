// Performance of a model on runs that it was not fitted to.
//
// Thread safety: values and pure functions; deterministic for a seed.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "gap/diagnose/effect_values.hpp"
#include "gap/diagnose/folds.hpp"
#include "gap/diagnose/gap_size.hpp"
#include "gap/diagnose/side_by_side.hpp"

namespace kenaf::gap::diagnose {

// The data of a stage.
struct StageView {
  const std::vector<StageFeatures>* features;
  const std::vector<std::vector<std::size_t>>* repeats;
  const std::vector<Eigen::VectorXd>* residuals;  // of each run
  const NoiseFloor* floor;
};

// The gap on held-out runs, in units of noise. NaN: not measured.
struct GapMeasure {
  static constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();
  double before = kNotMeasured, after = kNotMeasured, floor = kNotMeasured;
  Interval shrink{kNotMeasured, kNotMeasured, kNotMeasured};
  Interval explains{kNotMeasured, kNotMeasured, kNotMeasured};
};
// `after`: a model's residual of each run. The floor is squares_of_floor(). Intervals from resampling groups of
// repeats: not measured if there is one.
GapMeasure measure_gap(const StageView& view, const std::vector<Eigen::VectorXd>& after, const Deviations& repeats,
                       std::uint64_t seed);

// For each run that is the only one of its manoeuvre, and without which some effect should gain less than `evidence` on
// the others: its first half, which ends where half of the model's squared shift is reached.
std::vector<RunPart> halves_of_runs_alone(const StageView& view, Passage passage, const StandingModel& standing,
                                          double evidence);

// The places of a model fitted without each fold, by run, for each of its parts, in the order of time. A single fold
// holds nothing out.
struct PlacesOfPart {
  RunPart part;
  std::vector<OnCurve> places;
};
std::vector<std::vector<PlacesOfPart>> places_held_out(const StageView& view, Passage passage,
                                                       const StandingModel& standing, const Folds& folds,
                                                       unsigned threads);

// Shares of the squared gap, on held-out runs, that a model, each of its effects, and sets of them remove: share of the
// model fitted to the other runs, less that without the effects, whose others keep their values or are refitted to all
// runs, whichever removes more. From curves; at most 1.
//
// `beyond_numbers`, `of_kind` and `model_of_kind` include errors of the description's numbers in both models, as
// estimated from the fitted runs, where they predict the held-out runs better than none: an effect gets no credit for
// what these explain as well.
struct HeldOutShares {
  // Shares in the stage, and in the kind of channels in which the effect removes most.
  struct OfEffect {
    double of_stage = 0, beyond_numbers = 0, of_kind = 0;
    std::size_t kind = 0;
    double model_of_kind = 0;  // share of the whole model there
    // Expected deviance gain of the effect, or of all of a set together, on the fitted runs, if the model is right; the
    // smallest of all folds. If small, only the held-out runs show it, and the others cannot predict it.
    double shown_by_others = 0;
    double model_of_stage = 0;  // share of the whole model in the stage, measured like of_stage
  };
  std::vector<OfEffect> effects;  // in the order of the model's places
  // Share of several effects together; each alone may remove little, as the others compensate for it.
  struct OfSet {
    std::vector<std::size_t> places;  // two or more, ascending
    OfEffect share;
  };
  std::vector<OfSet> sets{};  // sets of interest, small ones first; shares_of_sets_held_out()
  double model = 0;           // of the stage
};
//
// `without_each`: simulated models without each of the effects, the others at their values; empty: from the sum of
// curves.
HeldOutShares shares_held_out(const StageView& view, Passage passage, const StandingModel& standing,
                              const std::vector<Model>& without_each, const Folds& folds, unsigned threads);

// Every set of two and more of these places, small ones first.
std::vector<std::vector<std::size_t>> sets_small_first(std::span<const std::size_t> places);
// `without_sets`: like without_each, for each of the sets.
std::vector<HeldOutShares::OfSet> shares_of_sets_held_out(const StageView& view, Passage passage,
                                                          const StandingModel& standing,
                                                          std::span<const std::vector<std::size_t>> sets,
                                                          const std::vector<Model>& without_sets, const Folds& folds,
                                                          unsigned threads);

}  // namespace kenaf::gap::diagnose
