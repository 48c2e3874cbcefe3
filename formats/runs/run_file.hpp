// One run of a `kenaf-runs/1` dataset: a CSV file with named columns in SI units, one row per sample time.
// docs/logs.md describes the format. Real logs and simulated logs share it.
//
// Frames: world x forward at the start, y left, z up; body x forward, y left, z up; pitch positive nose down.
//
// Thread safety: values and pure functions; a RunWriter belongs to one thread.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace kenaf::runs {

inline constexpr double kSameTime_s = 1e-9;  // tolerance: sample times are multiples of no binary fraction

// An error in a file, with file, line and column (both from 1) in its text.
class RunFileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// A run in memory, column by column. A cell that was not measured is NaN.
struct Run {
  std::vector<std::string> columns;         // "t_s" is always among them
  std::vector<std::vector<double>> values;  // values[column][row]
  // How the file was read where it is not as docs/logs.md describes: "semicolons between the cells, decimal commas".
  std::string reading{};
  std::size_t first_line = 2;  // of the first row in the file, from 1

  std::size_t row_count() const { return values.empty() ? 0 : values.front().size(); }
  // The values of a column, or an empty span if the run does not have it.
  std::span<const double> column(std::string_view name) const;
};

// Whether a column has any cell that is not NaN.
bool any_measured(std::span<const double> column);

// Reads a run. Other forms of CSV are recognised and named in Run::reading: semicolons or tabs between the cells, which
// may have decimal commas then; times in another unit (time_stamps.hpp), which become seconds. Cells may be quoted (RFC
// 4180), lines that begin with # may precede the header. A last line without its end that is cut off within a row is
// left out, and named in Run::reading. Throws RunFileError if there is no such file or no t_s, times do not strictly
// increase, a cell is no finite number, a file has decimal points and decimal commas, a row has another count of cells,
// a column is named twice or not at all, or there are more than 2^24 values (an hour of 40 columns at 100 Hz has
// fewer). Unknown columns are kept. Memory is bounded by the values, not by the file.
Run read_run(const std::filesystem::path& file);
Run parse_run(std::string_view text, std::string_view name_for_errors);

// Writes a run row by row to `<file>.part`, which finish() renames, so that `file` is complete or absent.
// All numbers are written with enough digits to read back the same double.
class RunWriter {
 public:
  // Throws RunFileError if the file cannot be created, or read_run() would refuse its columns.
  RunWriter(std::filesystem::path file, std::vector<std::string> columns);
  ~RunWriter();  // without finish(): the part file stays for inspection
  RunWriter(const RunWriter&) = delete;
  RunWriter& operator=(const RunWriter&) = delete;

  // Writes one value for each column; NaN makes an empty cell. Throws RunFileError if the file cannot be written, or
  // read_run() would refuse the row: another count of values, infinity, a time not after the row before. A refused row
  // is left out, and the next may follow. When this returns, the operating system has the row.
  void add_row(std::span<const double> row);
  // Throws RunFileError if the file is incomplete or cannot be renamed. A second call does nothing.
  void finish();

 private:
  std::filesystem::path file_;
  std::size_t column_count_ = 0;
  std::size_t time_column_ = 0;
  double last_time_s_;
  std::string line_;
  bool broken_ = false;
  int descriptor_ = -1;
};

// Writes a whole run by a RunWriter.
void write_run(const std::filesystem::path& file, const Run& run);

}  // namespace kenaf::runs
