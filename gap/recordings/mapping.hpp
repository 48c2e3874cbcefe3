// The mapping of a recording to the columns of a run: which topic or column, in which unit, frame and sign, how much
// later than the robot. docs/logs.md has the file's keys.
//
// Thread safety: values and pure functions.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gap/logs/capture_up.hpp"

namespace kenaf::gap::recordings {

enum class TimeFrom {
  header,  // `header.stamp` of the message; its log time where that is zero or missing
  log,     // when it was recorded
};

// How values come to the rows' times.
enum class Sampling {
  hold,     // the newest value before: commands, which are in force until the next
  linear,   // between the values before and after
  nearest,  // each value in the row nearest to it, other rows empty: sensors slower than the rows
};

// A topic with the path of a field behind it, "/cmd_vel/linear.x", or a column of a table.
struct Source {
  std::string from;
  TimeFrom time = TimeFrom::header;  // of a topic

  bool operator==(const Source&) const = default;
  auto operator<=>(const Source&) const = default;
};

struct Timing {
  TimeFrom time = TimeFrom::header;
  double delay_s = 0;  // how long after the measured moment the recording says that it was
  Sampling sampling = Sampling::linear;
  // The longest time that hold bridges, or between the two values of linear. Empty: 1 s of hold, 2.5 median steps of
  // linear. Beyond one that is given, a held command of a track is 0: the track stops.
  std::optional<double> max_gap_s{};
};

// run column = factor * source
struct ColumnMapping {
  std::string column;  // "track_left_mps"
  std::string from;
  double factor;  // unit, sign and further factor
  Timing timing;
};

// Both tracks from the speed v and turn rate w of the whole robot: left = v - w gauge / 2, right = v + w gauge / 2.
struct DriveMapping {
  bool commanded;  // the columns cmd_track_..._mps, else track_..._mps
  std::string v, w;
  double v_factor, w_factor;      // to m/s and rad/s, positive forward and to the left
  std::optional<double> gauge_m;  // empty: the robot's
  Timing timing;
};

struct PoseMapping {
  std::vector<std::string> position;  // x, y and, if measured, z
  std::vector<std::string> rotation;
  // As TablePose::order, also of one or two axes: "z" of a heading alone.
  std::string order;
  double length_factor, angle_factor;  // to m and rad
  std::optional<logs::Up> up{};        // the axis that points up; empty: z, unless another is seen
  bool keep_frame = false;             // otherwise the first pose becomes the origin, x forward
  Timing timing;                       // sampling: always linear
};

struct Mapping {
  std::string form;         // of the recording for which it was made
  std::string time_column;  // of a table
  double time_unit_s = 1;   // of that column
  std::string rows;         // the column whose samples' times the rows have, or "pose"; empty: every_s
  double every_s = 0;       // the rows' period, where `rows` is empty
  std::vector<ColumnMapping> columns;
  std::vector<DriveMapping> drives;
  std::optional<PoseMapping> pose;
};

// Throws description::DescriptionError with file, line and column if the text is no TOML, a key is missing, unknown or
// has a wrong value, a unit is none of its column's, two entries write one column, or `rows` is written by none.
Mapping parse_mapping(std::string_view toml_text, const std::string& name_for_errors);

// All sources of a mapping, each once.
std::vector<Source> sources_of(const Mapping& mapping);

// The columns that a drive writes, left before right.
std::array<std::string, 2> columns_of(const DriveMapping& drive);

}  // namespace kenaf::gap::recordings
