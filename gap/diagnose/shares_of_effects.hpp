// What each effect of a stage's best model takes off on runs held out, with the model without it as it simulates.
//
// Thread safety: pure functions apart from what the simulator does.
#pragma once

#include "gap/diagnose/decision_settings.hpp"
#include "gap/diagnose/evidence.hpp"

namespace kenaf::gap::diagnose {

// Groups of repeats held out, and whole manoeuvres. Sets where an effect takes off too little alone: all of them by
// curves, and those that take off enough then as simulated.
struct SharesOfEffects {
  HeldOutShares of_repeats, of_manoeuvres;
};
SharesOfEffects shares_of_effects(const StageView& view, Passage passage, const StandingModel& best,
                                  const Simulate& simulate, const Folds& by_repeat, const Folds& by_manoeuvre,
                                  const DecisionSettings& settings);

}  // namespace kenaf::gap::diagnose
