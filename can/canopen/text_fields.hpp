// Words, numbers and bytes in the lines of text logs. Pure functions on views; nothing is allocated but for errors.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "can/canopen/recorded_frame.hpp"

namespace kenaf::canopen::text {

inline int digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return -1;
}

inline bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r';
}

inline bool is_decimal(std::string_view text) {
  return !text.empty() && std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
}

inline std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

// Returns the first word of `rest` and removes it with the blanks around it; empty at the end.
inline std::string_view take_word(std::string_view& rest) {
  rest = trimmed(rest);
  const auto end = static_cast<std::size_t>(std::ranges::find_if(rest, is_blank) - rest.begin());
  const std::string_view word = rest.substr(0, end);
  rest = trimmed(rest.substr(end));
  return word;
}

// Text of a log as an error message quotes it: printable, and not longer than a line.
std::string quoted(std::string_view text);

// An unsigned number of at most `max_digits` digits (up to 8 in hexadecimal, 9 in decimal); nullopt for anything else.
std::optional<std::uint32_t> hexadecimal(std::string_view digits, std::size_t max_digits = 8);
std::optional<std::uint32_t> decimal(std::string_view digits);

// "1436509052.249713", up to 9e9 with up to nine digits behind the point, as a number of `unit` (a second, a
// millisecond); nullopt for anything else. Digits beyond the nanosecond are dropped.
std::optional<Time> time_of(std::string_view number, Time unit = std::chrono::seconds(1));

}  // namespace kenaf::canopen::text
