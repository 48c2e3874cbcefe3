// Effects beside one another: a robot that is heavier and whose mass is higher up tips elsewhere, and what a little more of
// one does to it there is not what it does to the nominal robot.
//
// The search adds what each effect does alone and corrects the sum by simulation at one place. That finds which effects they
// are; for their values, for whether manoeuvres agree on them and for their intervals it takes the slopes where they stand.
// Thread safety: pure functions apart from what the simulator callbacks do.
#pragma once

#include "gap/diagnose/model_search.hpp"

namespace kenaf::gap {

// `model`, of several effects, fitted again by what they do beside one another; never worse than it was. Curves of its effects are
// those from here on: every run simulated at its values and a tenth of the way from neutral to either side of each, and
// straight on from there to half of the way and to the end of the range. Columns of before stay. A single effect stays as it is, for its
// curve is simulated where it stands, and so does a model with an effect at its neutral value.
Model fit_side_by_side(EffectCurves& curves, const Coherence& coherence, const Simulator& simulator, Model model);

}  // namespace kenaf::gap
