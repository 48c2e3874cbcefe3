// What other stages say of a stage's candidates: the same robot drove in all of them, so what one names is no surprise
// in another, and what one speaks against is no cause in another.
//
// Thread safety: values.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

#include "gap/diagnose/evidence.hpp"
#include "gap/diagnose/stage_features.hpp"

namespace kenaf::gap::diagnose {

// An effect that another stage names, alone.
struct NamedElsewhere {
  std::size_t candidate;
  Interval value;
};

// A candidate that another stage sees: at the value that this one gives it, more would be left there.
struct RefutedElsewhere {
  std::size_t candidate;
  Passage by;
};

struct Elsewhere {
  std::vector<NamedElsewhere> named{};
  std::vector<RefutedElsewhere> refuted{};

  // The stage that does, if any.
  std::optional<Passage> refutes(std::size_t candidate) const {
    const auto found = std::ranges::find(refuted, candidate, &RefutedElsewhere::candidate);
    return found == refuted.end() ? std::nullopt : std::optional(found->by);
  }
};

}  // namespace kenaf::gap::diagnose
