// Selects the candidates that get curves over their whole range, after a first look at all: those whose linear shift
// explains enough at some amount.
//
// Thread safety: a pure function.
#pragma once

#include <span>
#include <vector>

#include "gap/diagnose/effect_curves.hpp"

namespace kenaf::gap::diagnose {

// Returns those of `looked_at`, in their order, that meet one of these:
// - they explain at least 1 % of the gap, and more than chance, under `discrepancies`; at most 24. The discrepancies
//   discount candidates that act like the model's own errors;
// - they are among the three of a kind of channels that explain most of its gap in noise alone, at least a fifth: an
//   offset of a whole run (a battery's voltage) is one independent number under a discrepancy, and negligible among
//   thousands of bins;
// - their linear shift is meaningless: they shift hardly anything near the present value, and more than the gap far
// out.
std::vector<std::size_t> candidates_that_matter(const StageData& data, const EffectCurves& curves,
                                                std::span<const std::size_t> looked_at,
                                                const Discrepancies& discrepancies);

}  // namespace kenaf::gap::diagnose
