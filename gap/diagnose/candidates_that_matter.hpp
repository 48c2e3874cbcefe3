// Which candidates get curves over all of their range, after a first look at all: those that by one linear step explain
// enough to matter, whatever their value.
//
// Thread safety: a pure function.
#pragma once

#include <span>
#include <vector>

#include "gap/diagnose/effect_curves.hpp"

namespace kenaf::gap::diagnose {

// Of `looked_at`, in their order:
// - at most 24 that explain at least 1 % of the gap beneath `discrepancies`, and more than chance does: beneath them
// those stand
//   back that act as what the model lacks does;
// - of each kind of channels the three best that explain at least a fifth of its gap in noise alone: what is the same
// in all of a run
//   (a battery's voltage) is one independent number a run beneath a discrepancy, and next to nothing beside thousands
//   of bins;
// - those of which a linear step says nothing: they do next to nothing near the present value, and more than the gap
// far out.
std::vector<std::size_t> candidates_that_matter(const StageData& data, const EffectCurves& curves,
                                                std::span<const std::size_t> looked_at,
                                                const Discrepancies& discrepancies);

}  // namespace kenaf::gap::diagnose
