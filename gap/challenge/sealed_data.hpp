// The data of a challenge's cases, made again from its key where they are not there.
//
// The key has what was sought when the cases were made: values, amounts, manoeuvres. To make their runs again takes
// seconds a case where seeking takes minutes, and does not hang on the last bit of what was sought.
// Deterministic, on any number of threads.
#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <functional>

#include "gap/challenge/key.hpp"

namespace kenaf::gap::challenge {

// Makes each dataset of `key` that is not in DIR/cases as it was sealed; others are left alone. After each it tells
// `progress` how many of the missing ones are made. Throws std::runtime_error where what is made is not what was
// sealed, by another version of the program or another kind of machine: no dataset is replaced by it. Throws Stopped
// soon after `stop`, if there is one, is true; what was made by then stays.
void make_missing_data(const std::filesystem::path& folder, const ChallengeKey& key, unsigned jobs,
                       const std::atomic<bool>* stop,
                       const std::function<void(std::size_t made, std::size_t missing)>& progress);

}  // namespace kenaf::gap::challenge
