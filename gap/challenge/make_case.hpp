// Makes the data of a case: effects of the planned size, and runs of a robot that has them. Deterministic for a plan,
// on any number of threads.
#pragma once

#include <atomic>
#include <filesystem>

#include "gap/challenge/plan.hpp"

namespace kenaf::gap::challenge {

// Writes the dataset to `folder`, which must not exist, as that of a real robot; for a baseline also the earlier runs
// to its kBeforeFolder: the same robot without its effect, with noise and start poses of their own. Sets the values,
// sizes and shares in `plan`. If the planned manoeuvres cannot show an effect of the planned size, or cannot tell an
// effect outside the catalogue from those in it, they are exchanged for others that can. If none can, the effect is as
// large as they show it, and `look_alike` says how far apart the two are. Throws Stopped soon after `stop` becomes true
// (it may be null); then the contents of `folder` must be discarded.
void make_case(CasePlan& plan, const std::filesystem::path& folder, unsigned jobs,
               const std::atomic<bool>* stop = nullptr);

// Writes the same files once more for a plan that make_case() has completed. Otherwise as make_case().
void make_again(const CasePlan& plan, const std::filesystem::path& folder, unsigned jobs,
                const std::atomic<bool>* stop = nullptr);

// Writes runs of the same robot in the manoeuvre that the dataset does not have.
void make_unseen(const CasePlan& plan, const std::filesystem::path& folder, unsigned jobs);

}  // namespace kenaf::gap::challenge
