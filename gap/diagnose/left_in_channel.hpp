// What a model leaves in a single channel. The sum over all channels has room for a lot in one of them: the floor is wide where sensors
// are finer than any gap that matters, so that the others are far below chance together.
// Thread safety: pure functions.
#pragma once

#include "gap/diagnose/coherence.hpp"
#include "gap/diagnose/model_search.hpp"

namespace kenaf::gap {

struct LeftInChannel {
  std::size_t channel = 0;  // of diagnosis_channels(): where there is least chance of as much
  double p = 1;             // that any channel has as much by chance, were all independent; at most 1
};
// Of what was there without the model, in the same channel, `numerics` is left by right models too; variances are `inflation` of the
// floor's.
LeftInChannel left_in_channel(const EffectCurves& curves, const Model& model, const Coherence& coherence, double numerics,
                              double inflation);

}  // namespace kenaf::gap
