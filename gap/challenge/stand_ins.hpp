// Which names a diagnosis may not have either, where a challenge withholds an effect: those that do the same, so nearly
// that no runs tell them apart. What does exactly the same the diagnosis leaves out by itself (Candidate::same_as).
// Used by the challenge alone: a diagnosis with both says which ones it cannot tell apart.
//
// Thread safety: pure functions.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "gap/candidates/candidate.hpp"
#include "gap/challenge/plan.hpp"

namespace kenaf::gap::challenge {

// Names of candidates, for --without: what is withheld in a case, and what stands in for it. Empty in all other strata.
std::vector<std::string> withheld_names(const CasePlan& plan);

// The numbers of the description that do what this effect does, or nearly: a background has none of them moved, as the
// value of the effect would not be the hidden one then.
std::vector<std::string> numbers_like(std::string_view effect);

// Of the challenged robot's description.
const std::vector<candidates::Candidate>& challenged_numbers();
// The numbers of the description that no effect does the same as, or nearly: what withheld_number hides.
std::vector<std::string> numbers_like_nothing_else();

// An effect of the catalogue where that does the same as the named number of the description; else the name itself.
std::string same_effect(const std::string& name);

}  // namespace kenaf::gap::challenge
