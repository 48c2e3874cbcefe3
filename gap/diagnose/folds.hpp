// Which runs, or parts of runs, are held out of a fit together.
//
// Thread safety: values and pure functions.
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "gap/diagnose/observation.hpp"

namespace kenaf::gap::diagnose {

// A run from one time to another, since its start: all of it, where nothing else is said.
struct RunPart {
  // Not explicit: a run is the whole of it.
  RunPart(std::size_t of_run, double from = 0, double to = std::numeric_limits<double>::infinity())
      : run(of_run), from_s(from), to_s(to) {}
  std::size_t run;
  double from_s, to_s;

  bool holds(double t_s) const { return from_s <= t_s && t_s < to_s; }
  bool operator==(const RunPart&) const = default;
};

// Parts that are held out together: all parts of all folds together are every run once.
using Fold = std::vector<RunPart>;
using Folds = std::vector<Fold>;

// Runs dealt out in turn, manoeuvre by manoeuvre, to as many folds as the most repeated one has runs, at most five:
// repeats of a manoeuvre are in different folds. Where nothing is repeated, to as many folds as there are manoeuvres,
// at most five.
Folds folds_by_repeat(const std::vector<std::vector<std::size_t>>& repeats);
// All repeats of a manoeuvre together, dealt out to at most five folds.
Folds folds_by_manoeuvre(const Observations& observations);
// Of each of the runs of `first_halves`, that half in the first fold and the other one in the second, in place of the
// run. A single fold stays as it is.
Folds with_halves(Folds folds, std::span<const RunPart> first_halves);

// What of each run a fit uses; empty: all of all.
class UsedParts {
 public:
  UsedParts() = default;
  // What `fold` holds, or all but that.
  static UsedParts of(const Fold& fold) { return {fold, true}; }
  static UsedParts without(const Fold& fold) { return {fold, false}; }
  bool holds(std::size_t run, double t_s) const;

 private:
  UsedParts(const Fold& fold, bool inside) : fold_(fold), inside_(inside) {}
  Fold fold_;
  bool inside_ = false;
};

}  // namespace kenaf::gap::diagnose
