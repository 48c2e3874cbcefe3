// Recognises the form of a table by its first lines. For table.cpp.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gap/recordings/table.hpp"

namespace kenaf::gap::recordings {

// The most lines before the first row, chosen; Qualisys has twelve.
inline constexpr std::size_t kMostHeaderLines = 40;

struct TableForm {
  Table table;                 // form, remarks, poses; columns of all cells, by which rows are read
  std::vector<bool> used;      // by cell: whether it is a column of the table; others are left out
  std::size_t first_row;       // in the lines given
  char separator = ',';        // ' ': any number of blanks and tabs
  bool ends_at_blank = false;  // rows end at a blank line
  // Where the form counts frames instead of time: the column of frames (empty: rows count) and how many are in a
  // second.
  std::optional<double> frames_per_second{};
  std::string frame_column{};
  // Motion capture that writes a body that it does not see as zeros.
  bool zeros_are_missing = false;
};

// Recognises the form by the first lines of a file, at most kMostHeaderLines, without line ends. Throws RecordingError
// with what is missing.
TableForm recognise_table(std::span<const std::string> lines);

}  // namespace kenaf::gap::recordings
