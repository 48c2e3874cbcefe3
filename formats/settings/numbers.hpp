// Numbers that a person writes: by options and environment variables. The same text has the same value, or the same
// error, wherever it is given.
//
// Accepted are decimal numbers alone: "200", "-0.5", "1e-3"; whole numbers without sign, fraction and leading zeros.
// Refused are what other readers take for something: "nan", "inf", "0x10", "010", "1e999", "+1", " 1", "1 ", "1,5", "".
//
// Thread safety: pure functions; the program's locale makes no difference.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace kenaf::settings {

// Returns a finite number, or nullopt.
std::optional<double> number_from(std::string_view text);
std::optional<std::uint64_t> whole_number_from(std::string_view text);

// Ends of an error: "must be a number from 0 to 10", "must be a whole number from 0 to 65535".
std::string must_be_number(double min, double max);
std::string must_be_whole_number(std::uint64_t min, std::uint64_t max);

}  // namespace kenaf::settings
