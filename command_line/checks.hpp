// Checks of the values of options, for CLI::Option::check(). Every option that is not free text, a name or a file has
// one: the parser by itself wraps "-1" around to a large unsigned number, reads "010" as eight and "0x10" as sixteen,
// and finds "nan" in every range. --help shows what a check asks for.
//
// Thread safety: pure functions.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace kenaf::command_line {

constexpr std::uint64_t kMostJobs = 1000;  // largest value of an option --jobs

// "must be a whole number from 0 to 65535", "must be a number from 0 to 10": formats/settings/numbers.hpp has the
// grammar.
CLI::Validator whole_number(std::uint64_t min, std::uint64_t max);
CLI::Validator number_in(double min, double max);

// "must be ut2004 or udk", with the word that was probably meant.
CLI::Validator one_of(const std::vector<std::string>& words);

// The levels of the log of servers; "warning", the word used in the log, is read as "warn".
CLI::Validator log_level();  // for transform(), not for check()

// "must not be empty": of names and files that must be given if their option is.
CLI::Validator not_empty();

// What `read` throws as std::runtime_error: "must be ...". For values with a reader of their own.
CLI::Validator readable_by(std::function<void(const std::string& value)> read);

}  // namespace kenaf::command_line
