// Shares of each effect of a stage's best model on held-out runs, with simulations of the model without it.
//
// Thread safety: pure functions, except that the simulator runs.
#pragma once

#include "gap/diagnose/decision_settings.hpp"
#include "gap/diagnose/evidence.hpp"

namespace kenaf::gap::diagnose {

// With repeats held out, and with whole manoeuvres held out. If an effect explains too little alone, also sets: all
// from curves, and those that explain enough then by simulation.
struct SharesOfEffects {
  HeldOutShares of_repeats, of_manoeuvres;
};
SharesOfEffects shares_of_effects(const StageView& view, Passage passage, const StandingModel& best,
                                  const Simulate& simulate, const Folds& by_repeat, const Folds& by_manoeuvre,
                                  const DecisionSettings& settings);

}  // namespace kenaf::gap::diagnose
