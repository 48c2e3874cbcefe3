// Equivalence of an effect and a number that is a part of it (Candidate::part_of): the friction of all belts, and that
// of the main tracks. If these runs show no difference, as when flippers stay off the ground, the part is dropped
// rather than treated as a rival of the whole.
//
// Thread safety: a pure function, except that the simulator runs.
#pragma once

#include <span>
#include <vector>

#include "gap/diagnose/effect_curves.hpp"

namespace kenaf::gap::diagnose {

// Returns `possible` without the parts that shift these runs like their wholes at the same factor, to 1 % of the shift.
// Simulates part and whole once each, at a quarter of the whole's range.
std::vector<std::size_t> without_same_parts(const StageData& data, std::span<const candidates::Candidate> candidates,
                                            std::span<const std::size_t> possible, const Simulate& simulate);

}  // namespace kenaf::gap::diagnose
