#include "gap/recordings/mapping.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "formats/description/toml_reader.hpp"
#include "gap/recordings/table.hpp"
#include "gap/recordings/units.hpp"
#include "robot/columns.hpp"

namespace kenaf::gap::recordings {
namespace {

using description::TomlReader;

constexpr std::string_view kMappingFormat = "kenaf-mapping/1";
constexpr double kMostDelay_s = 3600, kMostGap_s = 1e6;  // chosen

std::string text_or(TomlReader& reader, std::string_view key, const std::string& fallback) {
  return reader.has(key) ? reader.text(key) : fallback;
}

// The value of a key that has one of a few words.
template <class Value>
Value one_of(TomlReader& reader, std::string_view key, Value fallback,
             std::initializer_list<std::pair<std::string_view, Value>> words) {
  if (!reader.has(key)) return fallback;
  const std::string text = reader.text(key);
  std::string all;
  for (const auto& [word, value] : words) {
    if (text == word) return value;
    all += fmt::format("{}\"{}\"", all.empty() ? "" : ", ", word);
  }
  reader.fail(key, "must be one of " + all);
}

Timing timing_in(TomlReader& reader, Timing defaults) {
  Timing timing = defaults;
  timing.time = one_of(reader, "time", defaults.time, {{"header", TimeFrom::header}, {"log", TimeFrom::log}});
  timing.delay_s = reader.number_or("delay_s", 0, {.min = -kMostDelay_s, .max = kMostDelay_s});
  timing.sampling = one_of(reader, "sample", defaults.sampling,
                           {{"hold", Sampling::hold}, {"linear", Sampling::linear}, {"nearest", Sampling::nearest}});
  if (reader.has("max_gap_s")) timing.max_gap_s = reader.number("max_gap_s", {.min = 0, .max = kMostGap_s});
  return timing;
}

// The factor of `key` with its sign, to `column_unit`.
double factor_in(TomlReader& reader, const std::string& unit_key, const std::string& sign_key,
                 std::string_view column_unit, std::optional<double> radius_m) {
  const std::string unit = text_or(reader, unit_key, std::string(column_unit));
  if (needs_radius(column_unit, unit) && !radius_m)
    reader.fail(unit_key,
                "needs radius_m, the radius of the sprocket with half the belt, to become " + std::string(column_unit));
  const std::optional<double> factor = unit_factor(column_unit, unit, radius_m);
  if (!factor) reader.fail(unit_key, fmt::format("must be one of {}", units_for(column_unit)));
  const int sign = reader.has(sign_key) ? reader.integer(sign_key, -1, 1) : 1;
  if (sign == 0) reader.fail(sign_key, "must be 1 or -1");
  return sign * *factor;
}

bool is_command(std::string_view column) {
  return column.starts_with("cmd_");
}

ColumnMapping column_in(TomlReader& reader, TimeFrom time) {
  ColumnMapping mapping{reader.text("column"), reader.text("from"), 1, {}};
  if (mapping.column == "t_s") reader.fail("column", "must not be t_s, which the rows give");
  const robot::Column* known = robot::find_column(mapping.column);
  std::optional<double> radius_m;
  if (reader.has("radius_m")) radius_m = reader.number("radius_m", description::kPositive);
  // Other columns than a run's own keep their numbers.
  if (known != nullptr) mapping.factor = factor_in(reader, "unit", "sign", known->unit, radius_m);
  mapping.factor *= reader.number_or("factor", 1);
  mapping.timing = timing_in(reader, {time, 0, is_command(mapping.column) ? Sampling::hold : Sampling::linear});
  reader.finish();
  return mapping;
}

DriveMapping drive_in(TomlReader& reader, TimeFrom time) {
  DriveMapping drive{};
  drive.commanded = one_of(reader, "columns", true, {{"command", true}, {"measured", false}});
  drive.v = reader.text("v");
  drive.w = reader.text("w");
  drive.v_factor = factor_in(reader, "v_unit", "v_sign", "m/s", std::nullopt);
  drive.w_factor = factor_in(reader, "w_unit", "w_sign", "rad/s", std::nullopt);
  if (reader.has("gauge_m")) drive.gauge_m = reader.number("gauge_m", description::kPositive);
  drive.timing = timing_in(reader, {time, 0, drive.commanded ? Sampling::hold : Sampling::linear});
  reader.finish();
  return drive;
}

// The columns of a rotation, and their order.
void read_rotation(TomlReader& reader, PoseMapping& pose) {
  const int given = int{reader.has("quaternion")} + int{reader.has("rotation_vector")} + int{reader.has("angles")};
  if (given != 1) reader.fail("quaternion", "must be there, or instead of it rotation_vector or angles");
  if (reader.has("quaternion")) {
    pose.rotation = reader.texts("quaternion", 4, 4);
    pose.order = "quaternion";
  } else if (reader.has("rotation_vector")) {
    pose.rotation = reader.texts("rotation_vector", 3, 3);
    pose.order = "vector";
  } else {
    pose.rotation = reader.texts("angles", 1, 3);
    pose.order = reader.text("order");
    const bool known = pose.order.find_first_not_of("xyz") == pose.order.npos;
    if (!known || pose.order.size() != pose.rotation.size())
      reader.fail("order",
                  "must name the axis of each angle, as \"zyx\": turn about z, then about the turned y, then x");
  }
}

PoseMapping pose_in(TomlReader& reader, TimeFrom time) {
  PoseMapping pose{};
  pose.position = reader.texts("position", 2, 3);
  read_rotation(reader, pose);
  const auto length = unit_factor("m", text_or(reader, "unit", "m"), std::nullopt);
  if (!length) reader.fail("unit", "must be one of m, mm, cm, ft, in");
  const auto angle = unit_factor("rad", text_or(reader, "angle_unit", "rad"), std::nullopt);
  if (!angle) reader.fail("angle_unit", "must be one of rad, deg, turn");
  pose.length_factor = *length;
  pose.angle_factor = *angle;
  if (reader.has("up"))
    pose.up = one_of(reader, "up", logs::Up::z,
                     {{"z", logs::Up::z}, {"y", logs::Up::y}, {"-y", logs::Up::minus_y}, {"-z", logs::Up::minus_z}});
  pose.keep_frame = one_of(reader, "frame", false, {{"start", false}, {"world", true}});
  pose.timing = timing_in(reader, {time, 0, Sampling::linear});
  if (pose.timing.sampling != Sampling::linear) reader.fail("sample", "of a pose must be \"linear\"");
  reader.finish();
  return pose;
}

// Adds a column that is written; fails if another entry writes it.
void add_written(const TomlReader& reader, std::string_view key, const std::string& column,
                 std::set<std::string>& all) {
  if (!all.insert(column).second)
    reader.fail(key, fmt::format("writes the column {}, which another entry writes", column));
}

void read_rows(TomlReader reader, const std::set<std::string>& written, Mapping& mapping) {
  if (reader.has("every_s") == reader.has("of")) reader.fail("of", "must be there, or every_s instead");
  if (reader.has("every_s")) mapping.every_s = reader.number("every_s", {.min = 1e-4, .max = 1e3});
  if (reader.has("of")) {
    mapping.rows = reader.text("of");
    if (!written.contains(mapping.rows)) reader.fail("of", "must be a column that an entry writes, or \"pose\"");
  }
  reader.finish();
}

// Returns the time of topics where their entries say nothing.
TimeFrom read_recording(TomlReader reader, Mapping& mapping) {
  mapping.form = reader.text("form");
  TimeFrom time = TimeFrom::header;
  if (reader.has("time_column")) {
    mapping.time_column = reader.text("time_column");
    const auto unit = seconds_of_time_unit(text_or(reader, "time_unit", "s"));
    if (!unit) reader.fail("time_unit", "must be one of s, ms, us, ns");
    mapping.time_unit_s = *unit;
  } else {
    time = one_of(reader, "time", time, {{"header", TimeFrom::header}, {"log", TimeFrom::log}});
  }
  reader.finish();
  return time;
}

}  // namespace

Mapping parse_mapping(std::string_view toml_text, const std::string& name_for_errors) {
  const toml::table file = description::parse_toml(toml_text, name_for_errors);
  TomlReader reader(file, "", name_for_errors);
  if (reader.text("format") != kMappingFormat) reader.fail("format", fmt::format("must be \"{}\"", kMappingFormat));
  Mapping mapping;
  const TimeFrom time = read_recording(reader.table("recording"), mapping);

  // The entries, and the columns that they write: each only once.
  std::set<std::string> written;
  for (TomlReader& entry : reader.tables("column")) {
    mapping.columns.push_back(column_in(entry, time));
    add_written(entry, "column", mapping.columns.back().column, written);
  }
  for (TomlReader& entry : reader.tables("drive")) {
    mapping.drives.push_back(drive_in(entry, time));
    for (const std::string& column : columns_of(mapping.drives.back())) add_written(entry, "columns", column, written);
  }
  if (reader.has("pose")) {
    TomlReader entry = reader.table("pose");
    mapping.pose = pose_in(entry, time);
    for (const char* column : {"x_m", "y_m", "z_m", "roll_rad", "pitch_rad", "yaw_rad", "pose"})
      add_written(entry, "position", column, written);
  }

  // The rows may be those of any column that is written.
  if (written.empty()) reader.fail("column", "must be there, or [[drive]] or [pose]: nothing is mapped");
  read_rows(reader.table("rows"), written, mapping);
  reader.finish();
  return mapping;
}

std::array<std::string, 2> columns_of(const DriveMapping& drive) {
  const std::string begin = drive.commanded ? "cmd_track_" : "track_";
  return {begin + "left_mps", begin + "right_mps"};
}

std::vector<Source> sources_of(const Mapping& mapping) {
  std::set<Source> sources;
  for (const ColumnMapping& column : mapping.columns) sources.insert({column.from, column.timing.time});
  for (const DriveMapping& drive : mapping.drives)
    for (const std::string& from : {drive.v, drive.w}) sources.insert({from, drive.timing.time});
  if (mapping.pose) {
    for (const std::string& from : mapping.pose->position) sources.insert({from, mapping.pose->timing.time});
    for (const std::string& from : mapping.pose->rotation) sources.insert({from, mapping.pose->timing.time});
  }
  return {sources.begin(), sources.end()};
}

}  // namespace kenaf::gap::recordings
