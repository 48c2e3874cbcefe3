// Decides which effects of a best model get a name, alone or in sets, from their shares on held-out runs, and with that
// the verdict of a stage with a gap.
//
// Thread safety: pure functions.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "gap/diagnose/stage_decision.hpp"

namespace kenaf::gap::diagnose {

// Places of the effects whose sets have to be tested: all if some effect may lack a sufficient share by itself, else
// none.
std::vector<std::size_t> places_of_sets(const HeldOutShares& shares, const HeldOutShares& shares_by_manoeuvre,
                                        const DecisionSettings& settings);

// Sets shares and doubts of the effects of a best model, joins them in sets, and sets the verdict. `shares`,
// `shares_by_manoeuvre`: with repeats and with manoeuvres held out.
void judge(StageDecision& decision, std::span<const candidates::Candidate> candidates, const HeldOutShares& shares,
           const HeldOutShares& shares_by_manoeuvre, const DecisionSettings& settings);

// Takes all names away if the whole model explains too little of the stage's squared gap where it is simulated on
// held-out runs (`on_runs`, a share; those of judge() come from curves) or on held-out manoeuvres (`on_manoeuvres`; the
// same if there is one manoeuvre). A complete model may have effects that one manoeuvre alone shows, of which the
// others predict nothing; beside a residual that nothing explains, such an effect may only resemble part of it.
void doubt_unless_simulated(StageDecision& decision, double on_runs, double on_manoeuvres,
                            const DecisionSettings& settings);

// Places of the effects with a name.
std::vector<std::size_t> places_with_name(const StageDecision& decision);
// Those, and of effects that only resemble what they explain, or that another stage names: without these, what they
// explain would bend the others' values.
std::vector<std::size_t> places_to_keep(const StageDecision& decision);
// Those, and of effects that only lack a share of the stage or of its model: these shares may change without the other
// effects.
std::vector<std::size_t> places_to_try(const StageDecision& decision);

// Takes names away from effects that differ too little from their present values (ModelEffect::sure_from).
void doubt_uncertain_values(StageDecision& decision, std::span<const candidates::Candidate> candidates);

}  // namespace kenaf::gap::diagnose
