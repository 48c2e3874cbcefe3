// Findings of other stages about a stage's candidates: the same robot drove in all of them, so what one names is
// plausible in another, and what one refutes is no cause in another.
//
// Thread safety: values.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "gap/diagnose/evidence.hpp"
#include "gap/diagnose/stage_features.hpp"

namespace kenaf::gap::diagnose {

// An effect that another stage names without rivals.
struct NamedElsewhere {
  std::size_t candidate;
  Interval value;
};

// A candidate that does not fit another stage: there it would increase the residual at the value that this stage gives
// it, or kinds of channels doubt it (fit_by_kind.hpp).
struct RefutedElsewhere {
  std::size_t candidate;
  Passage by;
};

struct Elsewhere {
  std::vector<NamedElsewhere> named{};
  std::vector<RefutedElsewhere> refuted{};
  // Error of the description's numbers, 1 sigma in their typical errors, for the intervals of a stage that hardly shows
  // it; 0 if no other stage does.
  double numbers_off = 0;

  bool refutes(std::size_t candidate) const {
    return std::ranges::count(refuted, candidate, &RefutedElsewhere::candidate) > 0;
  }
};

}  // namespace kenaf::gap::diagnose
