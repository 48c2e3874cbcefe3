// Makes the data of a case: effects of the size that is planned, and runs of a robot that has them.
// Deterministic for a plan, on any number of threads.
#pragma once

#include <atomic>
#include <filesystem>

#include "gap/challenge/plan.hpp"

namespace kenaf::gap::challenge {

// Writes the dataset to `folder`, which must not exist, as that of a real robot, and of a baseline the runs of before
// to its kBeforeFolder: the same robot without its effect, with noise and start poses of its own. Sets what `plan` has
// only then: values, sizes, shares. Where these manoeuvres cannot show an effect as large as planned, they are
// exchanged for others that can; where none can, the effect is as large as they show it. So they are where they cannot
// tell what is outside the catalogue from what is in it: `look_alike` says how far apart the two are in the end. Throws
// Stopped soon after `stop`, if there is one, is true; what is in `folder` by then is to be thrown away.
void make_case(CasePlan& plan, const std::filesystem::path& folder, unsigned jobs,
               const std::atomic<bool>* stop = nullptr);

// Writes the data of a case whose plan make_case() has completed once more: the same files. Else as make_case().
void make_again(const CasePlan& plan, const std::filesystem::path& folder, unsigned jobs,
                const std::atomic<bool>* stop = nullptr);

// Runs of the same robot in the manoeuvre that the dataset does not have.
void make_unseen(const CasePlan& plan, const std::filesystem::path& folder, unsigned jobs);

}  // namespace kenaf::gap::challenge
