// Formatting of the page; its wording is in gap/diagnose/report_words.hpp.
//
// Thread safety: pure functions.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "gap/diagnose/report_words.hpp"

namespace kenaf::gap::diagnose {

// A probability; tiny ones as "< 0.0001".
std::string probability(double p);

// An element with escaped text.
std::string paragraph(std::string_view text, std::string_view classes = {});
std::string section_head(std::string_view id, std::string_view title);
std::string with_capital(std::string text);  // its first letter

// A table whose first column is text and the others are numbers; cells are escaped.
struct Table {
  std::vector<std::string> head;
  std::vector<std::vector<std::string>> rows;
  std::vector<std::size_t> text_columns{0};  // aligned left
  std::vector<std::string> row_links{};      // of each row's first two cells; empty: none
};
std::string to_html(const Table& table);

}  // namespace kenaf::gap::diagnose
