#include "gap/recordings/table_cells.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <set>

#include "formats/runs/csv_cells.hpp"

namespace kenaf::gap::recordings {

std::string lower_case(std::string_view text) {
  std::string small(text);
  for (char& c : small) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return small;
}

bool is_blank_line(std::string_view line) {
  return line.find_first_not_of(" \t\r,;") == line.npos;
}

Cells cells_of(std::string_view line, char separator) {
  std::vector<runs::CsvCell> split;
  runs::split_cells(line, separator, split);
  Cells cells;
  for (const runs::CsvCell& cell : split) cells.push_back(runs::unquoted(cell));
  return cells;
}

Cells words_between_blanks(std::string_view line) {
  Cells words;
  while (!line.empty()) {
    const std::size_t begin = line.find_first_not_of(" \t\r");
    if (begin == line.npos) break;
    line.remove_prefix(begin);
    const std::size_t end = std::min(line.size(), line.find_first_of(" \t\r"));
    words.emplace_back(line.substr(0, end));
    line.remove_prefix(end);
  }
  return words;
}

bool is_number_text(const std::string& text) {
  return runs::DecimalNumbers().read(text).has_value();
}

std::optional<double> number_of_text(const std::string& text) {
  return runs::DecimalNumbers().read(text);
}

std::string cell_at(const Cells& cells, std::size_t i) {
  return i < cells.size() ? cells[i] : std::string();
}

Cells filled_forward(Cells cells, std::size_t size) {
  cells.resize(size);
  for (std::size_t i = 1; i < size; ++i)
    if (cells[i].empty()) cells[i] = cells[i - 1];
  return cells;
}

void make_names_unique(Cells& names) {
  std::set<std::string> taken;
  for (std::size_t i = 0; i < names.size(); ++i) {
    std::string name = names[i].empty() ? (i == 0 ? "index" : fmt::format("column {}", i + 1)) : names[i];
    for (int k = 2; !taken.insert(name).second; ++k)
      name = fmt::format("{} ({})", names[i].empty() ? "column" : names[i], k);
    names[i] = name;
  }
}

}  // namespace kenaf::gap::recordings
