// A table of numbers in time that another program wrote as text: CSV of rostopic, PlotJuggler and pandas, exports of
// motion capture (Motive, Vicon, Qualisys), trajectories (TUM, EuRoC).
//
// Thread safety: values and pure functions.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gap/logs/capture_up.hpp"

namespace kenaf::gap::recordings {

// A body whose pose the form itself says to be in these columns.
struct TablePose {
  std::string body;
  std::array<std::string, 3> position;  // columns of x, y, z
  std::vector<std::string> rotation;    // columns, as `order` says
  // "quaternion": x, y, z, w. "vector": axis times angle. Else the axes of intrinsic turns, as "xyz": turn about x,
  // then about the turned y, then about z as turned by both.
  std::string order;
  std::string unit, angle_unit;  // "mm"; "deg", empty of a quaternion
  logs::Up up = logs::Up::z;     // by the form's default, which its user may have changed
};

struct Table {
  std::string form;  // for people and mappings: "CSV of rostopic", "Motive", "CSV"
  std::vector<std::string> columns;
  std::vector<std::vector<double>> values;  // values[column][row]; NaN where there is no number
  std::string time_column;                  // the one that the form has or whose name says so; empty: none
  std::string time_unit = "s";              // its unit: "s", "ms", "us" or "ns"
  std::vector<TablePose> poses;
  // How the text was read and what was left out, with counts: "12 columns of 'Marker' are not read".
  std::vector<std::string> remarks;

  std::size_t row_count() const { return values.empty() ? 0 : values.front().size(); }
  std::span<const double> column(std::string_view name) const;
};

// Reads a table whose form is recognised by its first lines. Cells between commas, semicolons, tabs or blanks; decimal
// commas; quotes; comments (#) before the header; dates (ISO 8601) as seconds since 1970. Cells of text are left out
// and counted by column, so are rows with another count of cells. Throws RecordingError with the file's name if it has
// no header and is no trajectory, or has more than 2^24 cells. Memory is bounded by the cells, not by the file.
Table read_table(const std::filesystem::path& file);
Table parse_table(std::string_view text, std::string_view name_for_errors);

// Seconds in a unit of time_unit; empty if there is no such one.
std::optional<double> seconds_of_time_unit(std::string_view unit);

}  // namespace kenaf::gap::recordings
