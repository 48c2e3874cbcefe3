// What stays in the catalogue and looks most like something that is not in it.
//
// Where a case's runs cannot tell the two apart, no diagnosis of them could say `unknown` with reason: docs/gap-challenge.md.
#pragma once

#include <span>
#include <string>

#include "gap/challenge/compared_runs.hpp"
#include "gap/challenge/plan.hpp"

namespace kenaf::gap {

// `hidden`: what it shifts, without noise. The single effect that comes nearest to it at the best of all its values, by coarse
// simulations; in floors of `floor`. 90 degrees where none explains any of it. Deterministic.
LookAlike look_alike(ComparedRuns& runs, const NoiseFloor& floor, const Shift& hidden,
                     std::span<const std::string> without);

}  // namespace kenaf::gap
