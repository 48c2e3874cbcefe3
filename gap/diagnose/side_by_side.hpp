// Effects beside one another: a robot that is heavier and whose mass is higher up tips elsewhere, and what a little
// more of one does to it there is not what it does to the nominal robot. One alone may bend between neutral and where
// it stands, too: play of 0.03 degrees does nearly as much as play of 0.2.
//
// The search adds what each effect does alone and corrects the sum by simulation at one place. That finds which effects
// they are; for their values, for whether manoeuvres agree on them and for their intervals it takes the slopes where
// they stand.
//
// Thread safety: pure functions apart from what the simulator does.
#pragma once

#include "gap/diagnose/model_search.hpp"

namespace kenaf::gap::diagnose {

struct StandingModel {
  Model model;
  // All curves; those of its effects are known where they stand, beside the others: every run simulated at its values
  // and a tenth to a half of the way from neutral to either side of each, as far as it takes to see more than roughness
  // (less where it bends there), and straight on from there to half of the way and to the end of the range.
  EffectCurves curves;
};

// `model` fitted again by what its effects do where they stand, beside one another; never worse than it was. A model
// with an effect at its present value stays as it is.
StandingModel fit_side_by_side(const StageData& data, EffectCurves curves, const Simulate& simulate, Model model);

// The model without the effects at `places`, the others fitted again to `data`, where they stand.
Model fit_without(const StageData& data, const StandingModel& standing, std::span<const std::size_t> places);
// With the whole model's discrepancies.
Model values_without(const StageData& data, const StandingModel& standing, std::span<const std::size_t> places);

}  // namespace kenaf::gap::diagnose
