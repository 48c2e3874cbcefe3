#include "formats/runs/csv_cells.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace kenaf::runs {

namespace {

constexpr char kQuote = '"';

// Blanks around a cell; a tab is none where it separates the cells.
std::string_view blanks(char separator) {
  return separator == '\t' ? " " : " \t";
}

// The end of the quoted cell that begins at `begin`, behind its closing quote; npos if none encloses the whole cell.
std::size_t end_of_quoted(std::string_view line, std::size_t begin, char separator) {
  for (std::size_t i = begin + 1; i < line.size(); ++i) {
    if (line[i] != kQuote) continue;
    if (i + 1 < line.size() && line[i + 1] == kQuote) {
      ++i;
      continue;
    }
    const std::size_t next = line.find_first_not_of(blanks(separator), i + 1);
    return next == line.npos || line[next] == separator ? i + 1 : line.npos;
  }
  return line.npos;
}

}  // namespace

void split_cells(std::string_view line, char separator, std::vector<CsvCell>& cells) {
  cells.clear();
  for (std::size_t begin = 0;;) {
    const std::size_t first = std::min(line.size(), line.find_first_not_of(blanks(separator), begin));
    const std::size_t quoted_end =
        first < line.size() && line[first] == kQuote ? end_of_quoted(line, first, separator) : line.npos;
    const bool quoted = quoted_end != line.npos;
    const std::size_t end = std::min(line.size(), line.find(separator, quoted ? quoted_end : begin));
    const std::size_t text_begin = quoted ? first + 1 : std::min(first, end);
    std::string_view text =
        quoted ? line.substr(text_begin, quoted_end - 1 - text_begin) : line.substr(text_begin, end - text_begin);
    const std::size_t inner = std::min(text.size(), text.find_first_not_of(" \t"));
    text.remove_prefix(inner);
    text = text.substr(0, text.find_last_not_of(" \t") + 1);
    cells.push_back({text, text_begin + inner + 1, quoted});
    if (end == line.size()) return;
    begin = end + 1;
  }
}

char separator_of(std::string_view header, std::string_view name) {
  std::vector<CsvCell> cells;
  char most = ',';
  std::size_t most_cells = 1;
  for (const char separator : {',', ';', '\t'}) {
    split_cells(header, separator, cells);
    if (std::ranges::find(cells, name, &CsvCell::text) != cells.end()) return separator;
    if (cells.size() <= most_cells) continue;
    most_cells = cells.size();
    most = separator;
  }
  return most;
}

std::string unquoted(const CsvCell& cell) {
  std::string text;
  for (std::size_t i = 0; i < cell.text.size(); ++i) {
    text += cell.text[i];
    if (cell.quoted && cell.text[i] == kQuote) ++i;  // each quote inside is doubled
  }
  return text;
}

std::string as_csv_cell(const std::string& name) {
  std::vector<CsvCell> cells;
  split_cells(name, ',', cells);
  // a line that begins with # would be a comment
  if (cells.size() == 1 && unquoted(cells.front()) == name && !name.starts_with('#')) return name;
  std::string text(1, kQuote);
  for (const char c : name) text.append(c == kQuote ? 2 : 1, c);
  return text + kQuote;
}

std::optional<double> DecimalNumbers::read(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  const std::size_t at = text.find_first_of(".,");
  std::string with_point;
  if (at != text.npos) {
    if (mark_ != 0 && text[at] != mark_) return std::nullopt;
    if (text[at] == ',') {
      with_point = text;
      with_point[at] = '.';
      text = with_point;
    }
  }
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  if (at != text.npos && mark_ == 0) mark_ = with_point.empty() ? '.' : ',';
  return value;
}

}  // namespace kenaf::runs
