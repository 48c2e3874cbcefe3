// The names that a diagnosis must lack, too, if a challenge withholds an effect: those of candidates so similar, alone
// or together, that no runs tell them apart. Candidates that are exactly the same the diagnosis leaves out by itself
// (Candidate::same_as). Used by the challenge only: a diagnosis with both reports that it cannot tell them apart.
//
// Thread safety: pure functions.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "gap/candidates/candidate.hpp"
#include "gap/challenge/plan.hpp"

namespace kenaf::gap::challenge {

// Returns names of candidates for --without: the withheld ones of a case and their stand-ins. Empty in other strata.
std::vector<std::string> withheld_names(const CasePlan& plan);

// Whether either stands in for the other. A pair of them would be a single, and no report could name both.
bool stand_in_for_each_other(std::string_view one, std::string_view other);

// Returns the numbers of the description that do the same as this effect, or nearly. A background does not move them,
// because the effect's value would then not be the hidden one.
std::vector<std::string> numbers_like(std::string_view effect);

// Returns the numbers of the challenged robot's description.
const std::vector<candidates::Candidate>& challenged_numbers();
// Returns those that no effect resembles: withheld_number hides one of them.
std::vector<std::string> numbers_like_nothing_else();

// Returns the effect of the catalogue that does the same as the named number of the description; otherwise the name.
std::string same_effect(const std::string& name);

}  // namespace kenaf::gap::challenge
