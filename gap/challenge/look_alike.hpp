// Finds the effect in the catalogue that looks most like a hidden one outside it.
//
// If the runs of a case cannot tell the two apart, no diagnosis could say `unknown` with reason: docs/gap-challenge.md.
#pragma once

#include <span>
#include <string>

#include "gap/challenge/compared_runs.hpp"
#include "gap/challenge/plan.hpp"

namespace kenaf::gap::challenge {

// Fits `hidden`, the shift of the hidden effect without noise, by each single candidate at the best of its values, in
// each stage in which it shows, by coarse simulations and in units of the noise of `floors`. Returns the nearest
// candidate of the stage in which the two are most alike, because each stage is diagnosed by itself; 90 degrees if no
// candidate explains any of it. `without`: names that the diagnosis leaves out. Deterministic.
LookAlike look_alike(ComparedRuns& runs, const Floors& floors, const Differences& hidden,
                     std::span<const std::string> without);

}  // namespace kenaf::gap::challenge
