#include "gap/recordings/capture_forms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <set>

#include "gap/recordings/recording_error.hpp"
#include "gap/recordings/table_cells.hpp"

namespace kenaf::gap::recordings {
namespace {

// ---- Motive

std::string unit_of_motive(const std::string& name) {
  const std::string text = lower_case(name);
  return text == "millimeters" ? "mm" : text == "centimeters" ? "cm" : "m";
}

// The lines of a Motive header, cell by cell.
struct MotiveHeader {
  std::map<std::string, std::string> keys;
  Cells type, name, quantity, axis;
  std::size_t axis_line = 0;
};

MotiveHeader motive_header(std::span<const std::string> lines) {
  MotiveHeader header;
  const Cells pairs = cells_of(lines[0], ',');
  for (std::size_t i = 0; i + 1 < pairs.size(); i += 2) header.keys[pairs[i]] = pairs[i + 1];
  std::vector<Cells> above;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    Cells cells = cells_of(lines[i], ',');
    if (cell_at(cells, 0) == "Frame") {
      header.axis = std::move(cells);
      header.axis_line = i;
      break;
    }
    if (!is_blank_line(lines[i])) above.push_back(std::move(cells));
  }
  if (header.axis.empty() || above.size() < 3)
    throw RecordingError("an export of Motive without its lines of types and names; export it with the header");
  header.type = above[0];
  header.name = above[1];
  header.quantity = above.back();
  return header;
}

void add_motive_poses(const MotiveHeader& header, TableForm& form) {
  const auto rotation = header.keys.find("Rotation Type");
  const auto length = header.keys.find("Length Units");
  const std::string kind = rotation == header.keys.end() ? "quaternion" : lower_case(rotation->second);
  std::set<std::string> seen;
  for (std::size_t i = 0; i < form.table.columns.size(); ++i) {
    if (!form.used[i] || cell_at(header.name, i).empty() || !seen.insert(header.name[i]).second) continue;
    const std::string& name = header.name[i];
    TablePose pose{name,       {name + ".Position.X", name + ".Position.Y", name + ".Position.Z"},      {},
                   kind,       unit_of_motive(length == header.keys.end() ? "Meters" : length->second), "",
                   logs::Up::y};
    if (kind == "quaternion") {
      for (const char* axis : {"X", "Y", "Z", "W"}) pose.rotation.push_back(name + ".Rotation." + axis);
    } else {
      pose.angle_unit = "deg";
      for (const char axis : kind)
        pose.rotation.push_back(name + ".Rotation." +
                                static_cast<char>(std::toupper(static_cast<unsigned char>(axis))));
    }
    form.table.poses.push_back(std::move(pose));
  }
}

// ---- Vicon

void add_vicon_poses(const Cells& bodies, const Cells& units, TableForm& form) {
  std::set<std::string> seen;
  for (std::size_t i = 2; i < form.table.columns.size(); ++i) {
    const std::string& body = bodies[i];
    if (body.empty() || !seen.insert(body).second) continue;
    const auto has = [&](const std::string& axis) {
      return std::ranges::find(form.table.columns, fmt::format("{}.{}", body, axis)) != form.table.columns.end();
    };
    if (!has("TX") || !has("RX")) continue;

    // A rotation vector, or with a fourth number a quaternion; millimetres, and degrees unless the units say radians.
    TablePose pose{body,
                   {body + ".TX", body + ".TY", body + ".TZ"},
                   {body + ".RX", body + ".RY", body + ".RZ"},
                   "vector",
                   "mm",
                   "deg",
                   logs::Up::z};
    const auto rotation = std::ranges::find(form.table.columns, body + ".RX") - form.table.columns.begin();
    if (cell_at(units, static_cast<std::size_t>(rotation)) == "rad") pose.angle_unit = "rad";
    if (has("RW")) {
      pose.rotation.push_back(body + ".RW");
      pose.order = "quaternion";
      pose.angle_unit.clear();
    }
    form.table.poses.push_back(std::move(pose));
  }
}

// ---- Qualisys

// The lines above the rows: keys with their values, and the names of the columns.
struct QualisysHeader {
  std::map<std::string, Cells> keys;
  Cells axes;
  std::size_t first_row = 0;
};

QualisysHeader qualisys_header(std::span<const std::string> lines) {
  QualisysHeader header;
  for (std::size_t i = 0; i < lines.size() && header.axes.empty(); ++i) {
    Cells cells = cells_of(lines[i], '\t');
    if (std::ranges::find(cells, "Roll") != cells.end()) {
      header.axes = std::move(cells);
      header.first_row = i + 1;
    } else {
      const std::string key = cell_at(cells, 0);
      header.keys[key] = std::move(cells);
    }
  }
  if (header.axes.empty())
    throw RecordingError("an export of Qualisys without columns of Roll, Pitch and Yaw: export 6DOF data");
  while (!header.axes.empty() && header.axes.back().empty()) header.axes.pop_back();
  return header;
}

// Columns "body.axis"; each body begins with its X, before which its name may stand: "robot X".
void add_qualisys_columns(const QualisysHeader& header, TableForm& form) {
  const auto names = header.keys.find("BODY_NAMES");
  std::size_t bodies = 0;
  std::string name;
  for (const std::string& axis : header.axes) {
    const bool begins_body = axis == "X" || axis.ends_with(" X");
    if (begins_body) {
      name = names == header.keys.end() ? std::string() : cell_at(names->second, ++bodies);
      if (name.empty()) name = fmt::format("body {}", form.table.poses.size() + 1);
      form.table.poses.push_back({name,
                                  {name + ".X", name + ".Y", name + ".Z"},
                                  {name + ".Roll", name + ".Pitch", name + ".Yaw"},
                                  "xyz",
                                  "mm",
                                  "deg",
                                  logs::Up::z});
    }
    form.table.columns.push_back(name.empty() ? axis : name + "." + (begins_body ? "X" : axis));
  }
  make_names_unique(form.table.columns);
  form.used.assign(form.table.columns.size(), true);
}

}  // namespace

bool is_motive(std::span<const std::string> lines) {
  return lines[0].starts_with("Format Version,");
}

TableForm motive_form(std::span<const std::string> lines) {
  const MotiveHeader header = motive_header(lines);
  TableForm form;
  form.table.form = "Motive";
  form.first_row = header.axis_line + 1;

  // Columns of time and of rigid bodies are read; markers and the rest are counted by their type.
  std::map<std::string, std::size_t> left_out;
  for (std::size_t i = 0; i < header.axis.size(); ++i) {
    const bool is_time = header.axis[i].starts_with("Time");
    const std::string type = lower_case(cell_at(header.type, i)), quantity = cell_at(header.quantity, i);
    const bool is_body = type == "rigid body" && (quantity == "Rotation" || quantity == "Position");
    if (is_time && form.table.time_column.empty()) form.table.time_column = header.axis[i];
    if (i > 0 && !is_time && !is_body && !type.empty())
      ++left_out[is_body || type != "rigid body" ? cell_at(header.type, i) : "Rigid Body, " + quantity];
    form.used.push_back(is_time || is_body);
    form.table.columns.push_back(is_body ? fmt::format("{}.{}.{}", cell_at(header.name, i), quantity, header.axis[i])
                                 : header.axis[i].empty() ? fmt::format("column {}", i + 1)
                                                          : header.axis[i]);
  }
  make_names_unique(form.table.columns);
  for (const auto& [type, count] : left_out)
    form.table.remarks.push_back(fmt::format("{} columns of '{}' are not read", count, type));
  if (form.table.time_column.empty()) throw RecordingError("an export of Motive without its column of time");
  add_motive_poses(header, form);
  return form;
}

bool is_vicon(std::span<const std::string> lines) {
  constexpr std::string_view kSections[] = {"Segments", "Objects", "Trajectories", "Global Angles"};
  if (lines.size() < 5) return false;
  const std::string name = cell_at(cells_of(lines[0], ','), 0);
  return std::ranges::find(kSections, name) != std::end(kSections) &&
         is_number_text(cell_at(cells_of(lines[1], ','), 0));
}

TableForm vicon_form(std::span<const std::string> lines) {
  TableForm form;
  form.table.form = "Vicon";
  form.separator = ',';
  const Cells axes = cells_of(lines[3], ','), units = cells_of(lines[4], ',');
  const Cells bodies = filled_forward(cells_of(lines[2], ','), axes.size());
  if (cell_at(axes, 0) != "Frame")
    throw RecordingError("an export of Vicon whose fourth line does not begin with Frame");
  for (std::size_t i = 0; i < axes.size(); ++i)
    form.table.columns.push_back(i < 2 || bodies[i].empty() ? axes[i] : bodies[i] + "." + axes[i]);
  make_names_unique(form.table.columns);
  form.used.assign(form.table.columns.size(), true);
  form.first_row = 5;
  form.ends_at_blank = true;
  form.frames_per_second = number_of_text(cell_at(cells_of(lines[1], ','), 0));
  form.frame_column = "Frame";
  add_vicon_poses(bodies, units, form);
  return form;
}

bool is_qualisys(std::span<const std::string> lines) {
  return lines[0].starts_with("NO_OF_FRAMES");
}

TableForm qualisys_form(std::span<const std::string> lines) {
  const QualisysHeader header = qualisys_header(lines);
  TableForm form;
  form.table.form = "Qualisys";
  form.separator = '\t';
  form.zeros_are_missing = true;
  form.first_row = header.first_row;
  add_qualisys_columns(header, form);
  const auto frequency = header.keys.find("FREQUENCY");
  if (std::ranges::find(form.table.columns, "Time") != form.table.columns.end())
    form.table.time_column = "Time";
  else if (frequency != header.keys.end())
    form.frames_per_second = number_of_text(cell_at(frequency->second, 1));
  if (form.table.time_column.empty() && !form.frames_per_second)
    throw RecordingError("an export of Qualisys without a column Time and without FREQUENCY");
  return form;
}

}  // namespace kenaf::gap::recordings
