// Cells of CSV text (RFC 4180), also as spreadsheets and loggers of other countries write it: semicolons or tabs
// between the cells, decimal commas.
//
// Thread safety: values and pure functions.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kenaf::runs {

struct CsvCell {
  std::string_view text;  // without blanks and quotes around it; quotes inside are still doubled
  std::size_t column;     // of its first character in the line, from 1
  bool quoted;
};

// Splits a line at `separator` (comma, semicolon or tab) outside of quotes. A cell whose quotes do not enclose it whole
// is taken as it is.
void split_cells(std::string_view line, char separator, std::vector<CsvCell>& cells);

// The separator by which a header has the cell `name`; if there is none, the one that makes most cells; else a comma.
char separator_of(std::string_view header, std::string_view name);

// The text of a cell with each doubled quote once.
std::string unquoted(const CsvCell& cell);

// The name of a column as split_cells() reads it back at commas: in quotes where needed.
std::string as_csv_cell(const std::string& name);

// Reads numbers with a decimal point or a decimal comma, one of the two in all of a file.
class DecimalNumbers {
 public:
  // Returns a finite number; empty if the text is none, or has the other mark than those before.
  std::optional<double> read(std::string_view text);
  // The mark so far: '.', ',' or 0.
  char mark() const { return mark_; }

 private:
  char mark_ = 0;
};

}  // namespace kenaf::runs
