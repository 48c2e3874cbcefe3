// Checks of options' texts, for CLI::Option::check(), where CLI11 would take what is none: "-1" wraps around to a large
// unsigned number, "010" is eight, "nan" lies in every range.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace kenaf::gap::commands {

constexpr std::uint64_t kMostJobs = 1000;  // that an option --jobs takes

// Gives what is wrong with a text, in words; empty: nothing.
using OptionCheck = std::function<std::string(const std::string&)>;

OptionCheck whole_number(std::uint64_t max);  // from 0
OptionCheck number_in(double min, double max);

}  // namespace kenaf::gap::commands
