// What a model is worth on runs that it was not fitted to.
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

// Of each run that is the only one of its manoeuvre and without which the others do not show some effect, as that
// should gain less than `evidence` there: its first half, up to where half of what the model shifts in it is over.
std::vector<RunPart> halves_of_runs_alone(const StageView& view, Passage passage, const StandingModel& standing,
                                          double evidence);

// The places of a model fitted without the parts of each fold, for every run of each of its parts, in the order of
// time. A single fold holds nothing out.
struct PlacesOfPart {
  RunPart part;
  std::vector<OnCurve> places;
};
std::vector<std::vector<PlacesOfPart>> places_held_out(const StageView& view, Passage passage,
                                                       const StandingModel& standing, const Folds& folds,
                                                       unsigned threads);

// Shares of the squared gap that a model takes off, each of its effects and sets of them: with them, fitted to the runs
// that are not held out, less without them, the others as they are or fitted again to all runs, whichever takes off
// more. By curves, on runs held out; at most 1.
//
// `beyond_numbers`, `of_kind` and `model_of_kind` have numbers of the description that are a little off in either
// model, as the runs that are fitted to have them: what these explain as well is no share of an effect's.
struct HeldOutShares {
  // Of the stage, and of the kind of channels in which the effect takes off most.
  struct OfEffect {
    double of_stage = 0, beyond_numbers = 0, of_kind = 0;
    std::size_t kind = 0;
    double model_of_kind = 0;  // what the whole model takes off there
    // Deviance that the effect should take off the runs that are fitted to, if the model is right; of the fold where it
    // is least. Little: only the runs held out show the effect, and no others can foretell it.
    double shown_by_others = 0;
    double model_of_stage = 0;  // what the whole model takes off the stage, as of_stage is measured
  };
  std::vector<OfEffect> effects;  // in the order of the model's places
  // What several effects take off together, which none of them may do alone, as each takes up what the others leave.
  struct OfSet {
    std::vector<std::size_t> places;  // two or more, ascending
    OfEffect share;
  };
  std::vector<OfSet> sets{};  // those of interest, small ones first; shares_of_sets_held_out()
  double model = 0;           // of the stage
};
//
// `without_each`: as simulated, of the model without each of its effects, the others at its values; empty: as the
// curves add up.
HeldOutShares shares_held_out(const StageView& view, Passage passage, const StandingModel& standing,
                              const std::vector<Model>& without_each, const Folds& folds, unsigned threads);

// Every set of two and more of these places, small ones first.
std::vector<std::vector<std::size_t>> sets_small_first(std::span<const std::size_t> places);
// `without_sets`: as without_each, of the model without each of the sets.
std::vector<HeldOutShares::OfSet> shares_of_sets_held_out(const StageView& view, Passage passage,
                                                          const StandingModel& standing,
                                                          std::span<const std::vector<std::size_t>> sets,
                                                          const std::vector<Model>& without_sets, const Folds& folds,
                                                          unsigned threads);

}  // namespace kenaf::gap::diagnose
