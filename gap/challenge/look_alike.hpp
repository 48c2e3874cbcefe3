// What stays in the catalogue and looks most like something that is not in it.
//
// Where a case's runs cannot tell the two apart, no diagnosis of them could say `unknown` with reason:
// docs/gap-challenge.md.
#pragma once

#include <span>
#include <string>

#include "gap/challenge/compared_runs.hpp"
#include "gap/challenge/plan.hpp"

namespace kenaf::gap::challenge {

// `hidden`: what it shifts, without noise. In each stage in which it shows, the single candidate that comes nearest to
// it at the best of all its values, by coarse simulations, in units of the noise of `floors`; of these stages the one
// in which that is nearest of all, for a stage is diagnosed without the others. 90 degrees where none explains any of
// it. `without`: names that the diagnosis leaves out. Deterministic.
LookAlike look_alike(ComparedRuns& runs, const Floors& floors, const Differences& hidden,
                     std::span<const std::string> without);

}  // namespace kenaf::gap::challenge
