// The true shares of a case's gap that its hidden effects explain.
#pragma once

#include <atomic>
#include <filesystem>

#include "gap/challenge/plan.hpp"

namespace kenaf::gap::challenge {

// Sets the shares of each effect of `plan`, from which `dataset` was made, in each stage that shows it: the share of
// the squared gap that the model with all hidden effects explains, less that of the model without this one. Uses the
// diagnosis' own simulation, floor and measure (gap_size.hpp). Deterministic, on any number of threads. Throws Stopped
// soon after `stop` becomes true; it may be null.
void set_true_shares(CasePlan& plan, const std::filesystem::path& dataset, unsigned jobs,
                     const std::atomic<bool>* stop);

}  // namespace kenaf::gap::challenge
