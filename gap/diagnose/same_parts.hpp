// An effect and a number that is a part of what it changes (Candidate::part_of): the friction of all belts, and that of
// the main tracks. Where these runs do not show a difference, as where flippers stay off the ground, the part is no
// rival of the whole; one of them is enough.
//
// Thread safety: a pure function, apart from what the simulator does.
#pragma once

#include <span>
#include <vector>

#include "gap/diagnose/effect_curves.hpp"

namespace kenaf::gap::diagnose {

// `possible` without the parts that shift these runs as their wholes do, by the same factor, to 1 % of the shift. Two
// simulations for each part, of a quarter of the whole's range.
std::vector<std::size_t> without_same_parts(const StageData& data, std::span<const candidates::Candidate> candidates,
                                            std::span<const std::size_t> possible, const Simulate& simulate);

}  // namespace kenaf::gap::diagnose
