// What a model leaves in a single channel of the drives. The sum over all channels has room for a lot in one of them: the floor is
// wide where sensors are finer than any gap that matters, so that the others are far below chance together.
//
// Not of the pose: it integrates, so that one start that is a little off moves all cells after it, and chance of cells as if they
// were independent says nothing there. Nor is a little of a large gap against a model: even the right one is curved.
// Thread safety: pure functions.
#pragma once

#include <optional>

#include "gap/diagnose/coherence.hpp"
#include "gap/diagnose/model_search.hpp"

namespace kenaf::gap {

struct LeftInDrive {
  std::size_t channel;  // of diagnosis_channels()
  double p;             // that any channel of the drives has as much by chance; at most 1
  double share;         // of the gap's squared length in that channel
};
// A right model leaves no larger share of a channel's squared gap than this (chosen: docs/gap-method.md).
inline constexpr double kLeftByRight = 0.1;

// Of the channels of the drives that keep more than that share, the one with the least chance. Variances are `inflation` of the
// floor's.
std::optional<LeftInDrive> left_in_drives(const EffectCurves& curves, const Model& model, const Coherence& coherence,
                                          double inflation);

}  // namespace kenaf::gap
