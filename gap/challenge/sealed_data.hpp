// Makes missing data of a challenge's cases again from its key.
//
// The key has the results of the search by which the cases were made: values, amounts, manoeuvres. Making their runs
// again takes seconds a case, where the search takes minutes, and does not depend on the last bit of the search.
// Deterministic, on any number of threads.
#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <functional>

#include "gap/challenge/key.hpp"

namespace kenaf::gap::challenge {

// Makes each dataset of `key` that DIR/cases does not have as it was sealed; others are left alone. Calls `progress`
// after each with the number of missing ones made so far. Throws std::runtime_error if the result differs from what was
// sealed, by another version of the program or on another kind of machine; it then replaces no dataset. Throws Stopped
// soon after `stop` becomes true (it may be null); the datasets made by then stay.
void make_missing_data(const std::filesystem::path& folder, const ChallengeKey& key, unsigned jobs,
                       const std::atomic<bool>* stop,
                       const std::function<void(std::size_t made, std::size_t missing)>& progress);

}  // namespace kenaf::gap::challenge
