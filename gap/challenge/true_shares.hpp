// How much of a case's gap its hidden effects truly explain.
#pragma once

#include <atomic>
#include <filesystem>

#include "gap/challenge/plan.hpp"

namespace kenaf::gap::challenge {

// Sets the shares of each effect of `plan`, of which `dataset` is made, in each stage that shows it: the share of the
// squared gap that is gone with the model that has all hidden effects, less that of the model without this one. By the
// diagnosis' own simulation, floor and measure (gap_size.hpp). Deterministic, on any number of threads. Throws Stopped
// soon after `stop`, if there is one, is true.
void set_true_shares(CasePlan& plan, const std::filesystem::path& dataset, unsigned jobs,
                     const std::atomic<bool>* stop);

}  // namespace kenaf::gap::challenge
