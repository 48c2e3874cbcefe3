#include "formats/runs/run_file.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <utility>

#include "formats/runs/csv_cells.hpp"
#include "formats/runs/time_stamps.hpp"
#include "formats/runs/whole_file.hpp"

namespace kenaf::runs {

namespace {

constexpr std::string_view kTimeColumn = "t_s";
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";  // spreadsheets write it
// Limits of memory, chosen: 2^24 values are 134 MB.
constexpr std::size_t kMostValues = std::size_t{1} << 24, kLongestLine = std::size_t{1} << 20;
constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

// Line of an error in the text.
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

bool only_blanks(std::string_view text) {
  return text.find_first_not_of(" \t\r\n") == std::string_view::npos;
}

// Returns the index of the time column. Throws RunFileError if the header is invalid.
std::size_t check_columns(const std::vector<CsvCell>& cells, const Place& place) {
  std::set<std::string_view> names;
  for (const CsvCell& cell : cells) {
    if (cell.text.empty()) fail(place, cell.column, "a column without a name");
    if (cell.text.find('\r') != cell.text.npos) fail(place, cell.column, "a column name contains a line end");
    if (!names.insert(cell.text).second)
      fail(place, cell.column, "the column " + in_quotes(cell.text) + " is named twice");
  }
  const auto time = std::ranges::find(cells, kTimeColumn, &CsvCell::text);
  if (time == cells.end()) fail(place, 1, "no column t_s; the first line names the columns, t_s among them");
  return static_cast<std::size_t>(time - cells.begin());
}

double read_cell(const CsvCell& cell, const std::string& column_name, DecimalNumbers& numbers, const Place& place) {
  if (cell.text.empty()) return kNotMeasured;
  if (const std::optional<double> value = numbers.read(cell.text)) return *value;
  const bool by_mark = DecimalNumbers().read(cell.text).has_value();
  fail(place, cell.column,
       in_quotes(cell.text) + " in column " + in_quotes(column_name) +
           (by_mark ? std::string(" has another decimal mark than the numbers before, which have a decimal ") +
                          (numbers.mark() == ',' ? "comma" : "point")
                    : " is not a finite number; leave the cell empty where nothing was measured"));
}

std::string separated_by(char separator) {
  return separator == ';' ? "semicolons" : separator == '\t' ? "tabs" : "commas";
}

void check_time(double time_s, double last_time_s, std::size_t column, const Place& place) {
  if (std::isnan(time_s)) fail(place, column, "the row has no time; every row needs its t_s");
  if (time_s <= last_time_s)
    fail(place, column,
         "t_s does not increase from the row before: a duplicate stamp, a clock that was set back, or several runs in "
         "one file; cut the file into one for each run, or make runs of it by kenaf-gap import");
}

// Reads a run from its text piece by piece, so that of a long file only the values are held in memory.
class RunReader {
 public:
  explicit RunReader(std::string_view name_for_errors) : place_{name_for_errors, 0} {}

  void take(std::string_view text) {
    for (std::size_t end; (end = text.find('\n')) != text.npos; text.remove_prefix(end + 1)) {
      begun_.append(text.substr(0, end));
      take_line();
    }
    begun_.append(text);
    if (begun_.size() > kLongestLine) fail({place_.file, place_.line + 1}, kLongestLine, "the line is too long");
  }

  Run finish() {
    if (!begun_.empty() && !leave_out_cut_off()) take_line();
    if (!has_header_) fail({place_.file, 1}, 1, "the file is empty; its first line names the columns, t_s among them");
    count_in_seconds();
    run_.reading = reading();
    return std::move(run_);
  }

 private:
  void take_line() {
    std::string_view line = begun_;
    if (place_.line == 0 && line.starts_with(kByteOrderMark)) line.remove_prefix(kByteOrderMark.size());
    if (line.ends_with('\r')) line.remove_suffix(1);
    ++place_.line;
    if (!has_header_ && first_blank_ == 0 && line.starts_with('#')) {
      // a comment before the header
    } else if (!only_blanks(line)) {
      if (first_blank_ != 0) refuse_blank();
      has_header_ ? take_row(line) : take_header(line);
    } else if (first_blank_ == 0) {
      first_blank_ = place_.line;  // allowed at the end of the file only
      blank_ = line;
    }
    begun_.clear();
  }

  // A blank line before another line is refused with the error of a row or header without cells.
  void refuse_blank() {
    place_.line = first_blank_;
    has_header_ ? take_row(blank_) : take_header(blank_);
  }

  void take_header(std::string_view line) {
    separator_ = separator_of(line, kTimeColumn);
    split_cells(line, separator_, cells_);
    time_column_ = check_columns(cells_, place_);
    for (const CsvCell& cell : cells_) run_.columns.push_back(unquoted(cell));
    run_.values.resize(cells_.size());
    run_.first_line = place_.line + 1;
    has_header_ = true;
  }

  void take_row(std::string_view line) {
    split_cells(line, separator_, cells_);
    if (cells_.size() != run_.columns.size()) {
      const bool more = cells_.size() > run_.columns.size();
      fail(place_, more ? cells_[run_.columns.size()].column : line.size() + 1,
           "the row has " + std::to_string(cells_.size()) + " cells, but the " + header_in_words() + " names " +
               std::to_string(run_.columns.size()) + " columns" +
               (separator_ != ',' ? ", with " + separated_by(separator_) + " between them"
                : more            ? "; numbers with decimal commas need semicolons between the cells, or quotes"
                                  : ""));
    }
    if ((run_.row_count() + 1) * cells_.size() > kMostValues)
      fail(place_, 1,
           "more than " + std::to_string(kMostValues) + " values; that is beyond an hour of 40 columns at " +
               "100 Hz: cut the file into one for each run");
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      run_.values[i].push_back(read_cell(cells_[i], run_.columns[i], numbers_, place_));
    }
    const double time_s = run_.values[time_column_].back();
    check_time(time_s, last_time_s_, cells_[time_column_].column, place_);
    last_time_s_ = time_s;
  }

  // A last line without its end is left out if it is the beginning of a row: cells are missing, or its last is none
  // yet, as "-" or "1e". Returns whether it is.
  bool leave_out_cut_off() {
    if (!has_header_ || first_blank_ != 0 || only_blanks(begun_)) return false;
    split_cells(begun_, separator_, cells_);
    DecimalNumbers numbers = numbers_;
    const bool unfinished = !cells_.back().text.empty() && !numbers.read(cells_.back().text);
    const bool is_cut = cells_.size() < run_.columns.size() || (cells_.size() == run_.columns.size() && unfinished);
    if (is_cut)
      cut_off_ = "line " + std::to_string(place_.line + 1) + " left out, where the file is cut off within cell " +
                 std::to_string(cells_.size()) + " of " + std::to_string(run_.columns.size());
    return is_cut;
  }

  std::string header_in_words() const {
    return run_.first_line == 2 ? "first line" : "header in line " + std::to_string(run_.first_line - 1);
  }

  // Times in another unit become seconds. Steps of less than a double can tell apart then are refused.
  void count_in_seconds() {
    std::vector<double>& times = run_.values[time_column_];
    time_unit_ = time_unit(times);
    if (!time_unit_) return;
    double before_s = -std::numeric_limits<double>::infinity();
    for (std::size_t row = 0; row < times.size(); ++row) {
      times[row] /= time_unit_->in_a_second;
      check_time(times[row], std::exchange(before_s, times[row]), 1, {place_.file, run_.first_line + row});
    }
  }

  std::string reading() const {
    std::string text;
    if (separator_ != ',') text = separated_by(separator_) + " between the cells";
    if (numbers_.mark() == ',') text += (text.empty() ? "" : ", ") + std::string("decimal commas");
    if (time_unit_) text += (text.empty() ? "" : ", ") + ("t_s in " + time_unit_->words) + " converted to seconds";
    if (!cut_off_.empty()) text += (text.empty() ? "" : ", ") + cut_off_;
    return text;
  }

  Place place_;        // the last line taken; 0: none yet
  std::string begun_;  // a line whose end has not come yet
  bool has_header_ = false;
  std::size_t first_blank_ = 0, time_column_ = 0;
  char separator_ = ',';
  DecimalNumbers numbers_;
  std::optional<TimeUnit> time_unit_;
  std::string blank_, cut_off_;
  double last_time_s_ = -std::numeric_limits<double>::infinity();
  std::vector<CsvCell> cells_;
  Run run_;
};

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

bool any_measured(std::span<const double> column) {
  return std::ranges::any_of(column, [](double value) { return !std::isnan(value); });
}

Run read_run(const std::filesystem::path& file) {
  const std::string name = file.string();
  RunReader reader(name);
  read_in_chunks(file, [&reader](std::string_view chunk) { reader.take(chunk); });
  return reader.finish();
}

Run parse_run(std::string_view text, std::string_view name_for_errors) {
  RunReader reader(name_for_errors);
  reader.take(text);
  return reader.finish();
}

RunWriter::RunWriter(std::filesystem::path file, std::vector<std::string> columns)
    : file_(std::move(file)), column_count_(columns.size()), last_time_s_(-std::numeric_limits<double>::infinity()) {
  for (const std::string& column : columns) {
    if (!line_.empty()) line_ += ',';
    line_ += as_csv_cell(column);
  }
  const std::string name = file_.string();
  const Place place{name, 1};
  std::vector<CsvCell> cells;
  split_cells(line_, ',', cells);
  if (!std::ranges::equal(cells, columns, {}, unquoted) || line_.find('\n') != std::string::npos) {
    fail(place, 1, "a column name contains a line end, or begins or ends with a blank");
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
  if (broken_) refuse("an earlier row could not be written");
  if (row.size() != column_count_) {
    refuse("a row of " + std::to_string(row.size()) + " values for " + std::to_string(column_count_) + " columns");
  }
  if (!(row[time_column_] > last_time_s_)) refuse("t_s does not increase from the row before");
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
  if (broken_) throw RunFileError(file_.string() + ": remains a part file, because a row could not be written");
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
