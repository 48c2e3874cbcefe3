// Checks of option texts, for CLI::Option::check(), that refuse what CLI11 accepts: it wraps "-1" around to a large
// unsigned number, reads "010" as eight and finds "nan" in every range.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace kenaf::gap::commands {

constexpr std::uint64_t kMostJobs = 1000;  // largest value of an option --jobs

// Returns what is wrong with a text, in words; empty: nothing.
using OptionCheck = std::function<std::string(const std::string&)>;

OptionCheck whole_number(std::uint64_t max);  // from 0
OptionCheck number_in(double min, double max);

}  // namespace kenaf::gap::commands
