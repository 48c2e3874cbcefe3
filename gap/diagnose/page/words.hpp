// How the page names and writes things.
// Thread safety: pure functions.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gap/diagnose/diagnosis.hpp"

namespace kenaf::gap {

// With three significant digits; "-" where it is not known.
std::string figure(double value);
// A share, as "71 %", small ones as "0.4 %".
std::string percent(double share);
// A probability, "< 0.0001" at least.
std::string probability(double p);
// " m/s"; nothing for a ratio.
std::string unit_suffix(std::string_view unit);

// "0.0513 s (0.0498 to 0.0528)".
std::string interval_text(const Interval& interval, std::string_view unit);
std::string percent_interval(const Interval& share);

// "drive_lag lag_s", of a curve.
std::string parameter_name(const EffectCurve& curve);
// "a, b and c".
std::string enumeration(std::span<const std::string> names, std::string_view last_word = "and");
std::vector<std::string> curve_names(const Diagnosis& d, std::span<const std::size_t> curves);

// An element with escaped text.
std::string paragraph(std::string_view text, std::string_view classes = {});
std::string section_head(std::string_view id, std::string_view title);

// A table whose first column is text and the others are figures; cells are escaped.
struct Table {
  std::vector<std::string> head;
  std::vector<std::vector<std::string>> rows;
  std::vector<std::size_t> text_columns{0};  // aligned left
};
std::string to_html(const Table& table);

}  // namespace kenaf::gap
