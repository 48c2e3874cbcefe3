// Lines of tables as cells of text. For the forms of tables.
//
// Thread safety: pure functions.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kenaf::gap::recordings {

using Cells = std::vector<std::string>;

std::string lower_case(std::string_view text);
bool is_blank_line(std::string_view line);  // also one of separators alone

Cells cells_of(std::string_view line, char separator);
Cells words_between_blanks(std::string_view line);
std::optional<double> number_of_text(const std::string& text);  // with a decimal point or comma
bool is_number_text(const std::string& text);

// The cell of a row, or empty text beyond its end.
std::string cell_at(const Cells& cells, std::size_t i);

// `size` cells, each as in `cells` where it has text, else with the last text before it.
Cells filled_forward(Cells cells, std::size_t size);

// Makes no two columns have one name; unnamed ones are named by their place, the first "index".
void make_names_unique(Cells& names);

}  // namespace kenaf::gap::recordings
