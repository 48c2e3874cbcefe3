#include "runs/run_file.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <utility>

#include "runs/whole_file.hpp"

namespace kenaf::runs {

namespace {

constexpr std::string_view kTimeColumn = "t_s";
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";  // spreadsheets write it
constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

struct Cell {
  std::string_view text;  // without blanks around it
  std::size_t column;     // of its first character in the line, from 1
};

// Where in the text an error is.
struct Place {
  std::string_view file;
  std::size_t line;
};

[[noreturn]] void fail(const Place& place, std::size_t column, const std::string& what) {
  throw RunFileError(std::string(place.file) + ":" + std::to_string(place.line) + ":" + std::to_string(column) + ": " +
                     what);
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kLongest = 40;
  return "'" + std::string(text.substr(0, kLongest)) + (text.size() > kLongest ? "...'" : "'");
}

Cell trimmed(std::string_view text, std::size_t column) {
  const std::size_t first = std::min(text.size(), text.find_first_not_of(" \t"));
  text.remove_prefix(first);
  text = text.substr(0, text.find_last_not_of(" \t") + 1);
  return {text, column + first};
}

void split(std::string_view line, std::vector<Cell>& cells) {
  cells.clear();
  for (std::size_t begin = 0;;) {
    const std::size_t end = std::min(line.size(), line.find(',', begin));
    cells.push_back(trimmed(line.substr(begin, end - begin), begin + 1));
    if (end == line.size()) return;
    begin = end + 1;
  }
}

bool only_blanks(std::string_view text) {
  return text.find_first_not_of(" \t\r\n") == std::string_view::npos;
}

// Takes the next line, without its CR LF or LF.
std::string_view take_line(std::string_view& rest) {
  const std::size_t end = std::min(rest.size(), rest.find('\n'));
  std::string_view line = rest.substr(0, end);
  rest.remove_prefix(std::min(rest.size(), end + 1));
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

std::optional<double> finite_number(std::string_view text) {
  double value = 0;
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

// The index of the time column. Throws where the header is none.
std::size_t check_columns(const std::vector<Cell>& cells, const Place& place) {
  std::set<std::string_view> names;
  for (const Cell& cell : cells) {
    if (cell.text.empty()) fail(place, cell.column, "a column without a name");
    if (!names.insert(cell.text).second)
      fail(place, cell.column, "the column " + in_quotes(cell.text) + " is named twice");
  }
  const auto time = std::ranges::find(cells, kTimeColumn, &Cell::text);
  if (time == cells.end()) fail(place, 1, "no column t_s; the first line names the columns, t_s among them");
  return static_cast<std::size_t>(time - cells.begin());
}

double read_cell(const Cell& cell, const std::string& column_name, const Place& place) {
  if (cell.text.empty()) return kNotMeasured;
  const std::optional<double> value = finite_number(cell.text);
  if (!value) {
    fail(place, cell.column,
         in_quotes(cell.text) + " in column " + in_quotes(column_name) +
             " is no finite number; leave the cell empty where nothing was measured");
  }
  return *value;
}

void check_time(double time_s, double last_time_s, std::size_t column, const Place& place) {
  if (std::isnan(time_s)) fail(place, column, "the row has no time; every row needs its t_s");
  if (time_s <= last_time_s) fail(place, column, "t_s does not grow from the row before");
}

void append_number(std::string& out, double value) {
  std::array<char, 32> digits;
  out.append(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr);
}

}  // namespace

std::span<const double> Run::column(std::string_view name) const {
  const auto found = std::ranges::find(columns, name);
  if (found == columns.end()) return {};
  return values[static_cast<std::size_t>(found - columns.begin())];
}

Run read_run(const std::filesystem::path& file) {
  return parse_run(read_whole_file(file), file.string());
}

Run parse_run(std::string_view text, std::string_view name_for_errors) {
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  Place place{name_for_errors, 1};
  if (only_blanks(text)) fail(place, 1, "the file is empty; its first line names the columns, t_s among them");
  std::vector<Cell> cells;
  split(take_line(text), cells);
  const std::size_t time_column = check_columns(cells, place);

  Run run;
  for (const Cell& cell : cells) run.columns.emplace_back(cell.text);
  run.values.resize(cells.size());
  double last_time_s = -std::numeric_limits<double>::infinity();
  while (!text.empty()) {
    ++place.line;
    const std::string_view line = take_line(text);
    if (only_blanks(line) && only_blanks(text)) break;  // empty lines at the end
    split(line, cells);
    if (cells.size() != run.columns.size()) {
      fail(place, cells.size() > run.columns.size() ? cells[run.columns.size()].column : line.size() + 1,
           "the row has " + std::to_string(cells.size()) + " cells, but the first line names " +
               std::to_string(run.columns.size()) + " columns");
    }
    for (std::size_t i = 0; i < cells.size(); ++i) {
      run.values[i].push_back(read_cell(cells[i], run.columns[i], place));
    }
    const double time_s = run.values[time_column].back();
    check_time(time_s, last_time_s, cells[time_column].column, place);
    last_time_s = time_s;
  }
  return run;
}

RunWriter::RunWriter(std::filesystem::path file, std::vector<std::string> columns)
    : file_(std::move(file)), column_count_(columns.size()), last_time_s_(-std::numeric_limits<double>::infinity()) {
  for (const std::string& column : columns) {
    if (!line_.empty()) line_ += ',';
    line_ += column;
  }
  const std::string name = file_.string();
  const Place place{name, 1};
  std::vector<Cell> cells;
  split(line_, cells);
  if (cells.size() != columns.size() || line_.find_first_of("\r\n\"") != std::string::npos) {
    fail(place, 1, "a column's name has a comma, a quote or a line end in it");
  }
  time_column_ = check_columns(cells, place);
  line_ += '\n';
  descriptor_ = open_part_file(file_);
  try {
    append_to_part_file(descriptor_, file_, line_);
  } catch (...) {
    ::close(descriptor_);
    throw;
  }
}

RunWriter::~RunWriter() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void RunWriter::add_row(std::span<const double> row) {
  const auto refuse = [this](const std::string& what) { throw RunFileError(file_.string() + ": " + what); };
  if (descriptor_ < 0) refuse("is closed, no row can follow");
  if (broken_) refuse("a row before could not be written");
  if (row.size() != column_count_) {
    refuse("a row of " + std::to_string(row.size()) + " values for " + std::to_string(column_count_) + " columns");
  }
  if (!(row[time_column_] > last_time_s_)) refuse("t_s does not grow from the row before");
  line_.clear();
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (i > 0) line_ += ',';
    if (std::isinf(row[i])) refuse("infinity in column " + std::to_string(i + 1));
    if (!std::isnan(row[i])) append_number(line_, row[i]);
  }
  line_ += '\n';
  broken_ = true;  // until the whole row is written
  append_to_part_file(descriptor_, file_, line_);
  broken_ = false;
  last_time_s_ = row[time_column_];
}

void RunWriter::finish() {
  if (descriptor_ < 0) return;
  if (broken_) throw RunFileError(file_.string() + ": stays a part file, a row could not be written");
  finish_part_file(std::exchange(descriptor_, -1), file_);
}

void write_run(const std::filesystem::path& file, const Run& run) {
  RunWriter writer(file, run.columns);
  std::vector<double> row(run.columns.size());
  for (std::size_t i = 0; i < run.row_count(); ++i) {
    for (std::size_t c = 0; c < row.size(); ++c) row[c] = run.values[c][i];
    writer.add_row(row);
  }
  writer.finish();
}

}  // namespace kenaf::runs
