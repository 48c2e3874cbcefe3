// Around which models a stage was looked at. What is open around a model hardly depends on its values, but takes as
// long to simulate as all else about it: one look serves models that differ little.
//
// Thread safety: pure functions.
#pragma once

#include <span>
#include <vector>

#include "gap/diagnose/effect_curves.hpp"

namespace kenaf::gap::diagnose {

// Returns the first of `looks` that has the candidates of `settings` in their order, and whose values differ by less
// than a tenth of their distances from the present values; else adds `settings` and returns them. Valid until the next
// call.
const Settings& nearest_look(std::vector<Settings>& looks, const Settings& settings,
                             std::span<const candidates::Candidate> candidates);

}  // namespace kenaf::gap::diagnose
