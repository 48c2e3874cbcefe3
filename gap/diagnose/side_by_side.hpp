// Effects in combination, linearised at the fitted values: a heavier robot with a higher centre of mass tips elsewhere,
// so its derivatives differ from the nominal robot's. A single effect may be nonlinear, too: play of 0.03 degrees does
// nearly as much as play of 0.2.
//
// The search adds the shifts of single effects and corrects the sum by simulation at one point. That finds the effects;
// their values, agreement between manoeuvres and intervals need the derivatives at the fitted values.
//
// Thread safety: pure functions, except that the simulator runs.
#pragma once

#include "gap/diagnose/model_search.hpp"

namespace kenaf::gap::diagnose {

struct StandingModel {
  Model model;
  // All curves; those of its effects are taken with the others present: every run is simulated at the fitted values,
  // and for each value a tenth to a half of the way from neutral to either side, far enough to exceed roughness (less
  // at a bend); extrapolated linearly from there to half of the way and to the end of the range.
  EffectCurves curves;
};

// Refits `model` with the joint curves of its effects; never worse than before. A model with an effect at
// its present value is returned unchanged.
StandingModel fit_side_by_side(const StageData& data, EffectCurves curves, const Simulate& simulate, Model model);

// The model without the effects at `places`, the others refitted to `data` on the same curves.
Model fit_without(const StageData& data, const StandingModel& standing, std::span<const std::size_t> places);
// The same with the whole model's discrepancies.
Model values_without(const StageData& data, const StandingModel& standing, std::span<const std::size_t> places);

}  // namespace kenaf::gap::diagnose
