// Which effects of a best model get a name, alone or in sets, by what they are worth on runs held out.
//
// Thread safety: pure functions.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "gap/diagnose/stage_decision.hpp"

namespace kenaf::gap::diagnose {

// Places of the effects whose sets are of interest: all where some effect may lack a share by itself, else none.
std::vector<std::size_t> places_of_sets(const HeldOutShares& shares, const HeldOutShares& shares_by_manoeuvre,
                                        const DecisionSettings& settings);

// Names, sets and doubts of the effects of a best model. `shares`, `shares_by_manoeuvre`: with repeats and with
// manoeuvres held out.
void judge(StageDecision& decision, std::span<const candidates::Candidate> candidates, const HeldOutShares& shares,
           const HeldOutShares& shares_by_manoeuvre, const DecisionSettings& settings);

}  // namespace kenaf::gap::diagnose
