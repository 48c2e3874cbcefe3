// Folds of cross-validation: which runs, or parts of runs, are held out of a fit together.
//
// Thread safety: values and pure functions.
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "gap/diagnose/observation.hpp"

namespace kenaf::gap::diagnose {

// A run between two times since its start; by default all of it.
struct RunPart {
  // Not explicit: a run converts to the whole of it.
  RunPart(std::size_t of_run, double from = 0, double to = std::numeric_limits<double>::infinity())
      : run(of_run), from_s(from), to_s(to) {}
  std::size_t run;
  double from_s, to_s;

  bool holds(double t_s) const { return from_s <= t_s && t_s < to_s; }
  bool operator==(const RunPart&) const = default;
};

// Parts that are held out together. All folds together contain every run once.
using Fold = std::vector<RunPart>;
using Folds = std::vector<Fold>;

// Distributes the repeats of each manoeuvre over different folds: as many folds as the most repeated manoeuvre has
// runs, at most five. Without repeats, as many as there are manoeuvres, at most five.
Folds folds_by_repeat(const std::vector<std::vector<std::size_t>>& repeats);
// Keeps all runs of a manoeuvre together, in at most five folds. Where names do not tell manoeuvres apart (none, or the
// same for all runs), each group of repeats counts as one.
Folds folds_by_manoeuvre(const Observations& observations, const std::vector<std::vector<std::size_t>>& repeats);
// Replaces each run of `first_halves` by that half in the first fold and the other half in the second. A single fold is
// returned unchanged.
Folds with_halves(Folds folds, std::span<const RunPart> first_halves);

// The parts of each run that a fit uses; by default everything.
class UsedParts {
 public:
  UsedParts() = default;
  // The parts in `fold`, or everything else.
  static UsedParts of(const Fold& fold) { return {fold, true}; }
  static UsedParts without(const Fold& fold) { return {fold, false}; }
  bool holds(std::size_t run, double t_s) const;

 private:
  UsedParts(const Fold& fold, bool inside) : fold_(fold), inside_(inside) {}
  Fold fold_;
  bool inside_ = false;
};

}  // namespace kenaf::gap::diagnose
