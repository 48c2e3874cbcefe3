#include "gap/recordings/table_forms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <chrono>
#include <map>
#include <set>

#include "formats/runs/csv_cells.hpp"
#include "gap/recordings/recording_error.hpp"

namespace kenaf::gap::recordings {
namespace {

using Cells = std::vector<std::string>;

constexpr double kSecondsPerDay = 86400;

std::string lower(std::string_view text) {
  std::string small(text);
  for (char& c : small) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return small;
}

bool is_blank(std::string_view line) {
  return line.find_first_not_of(" \t\r,;") == line.npos;
}

Cells cells_of(std::string_view line, char separator) {
  std::vector<runs::CsvCell> split;
  runs::split_cells(line, separator, split);
  Cells cells;
  for (const runs::CsvCell& cell : split) cells.push_back(runs::unquoted(cell));
  return cells;
}

Cells words_of(std::string_view line) {
  Cells words;
  while (!line.empty()) {
    const std::size_t begin = line.find_first_not_of(" \t\r");
    if (begin == line.npos) break;
    line.remove_prefix(begin);
    const std::size_t end = std::min(line.size(), line.find_first_of(" \t\r"));
    words.emplace_back(line.substr(0, end));
    line.remove_prefix(end);
  }
  return words;
}

bool is_number_text(const std::string& text) {
  return runs::DecimalNumbers().read(text).has_value();
}

std::optional<double> number_in_text(const std::string& text) {
  return runs::DecimalNumbers().read(text);
}

// The cell of a row, or empty text beyond its end.
std::string cell(const Cells& cells, std::size_t i) {
  return i < cells.size() ? cells[i] : std::string();
}

// Each cell of `cells` where it has text, else the last text before it.
Cells filled_forward(Cells cells, std::size_t size) {
  cells.resize(size);
  for (std::size_t i = 1; i < size; ++i)
    if (cells[i].empty()) cells[i] = cells[i - 1];
  return cells;
}

void use_all(TableForm& form) {
  form.used.assign(form.table.columns.size(), true);
}

// No two columns of one name; unnamed ones are named by their place.
void make_names_unique(Cells& names) {
  std::set<std::string> taken;
  for (std::size_t i = 0; i < names.size(); ++i) {
    std::string name = names[i].empty() ? (i == 0 ? "index" : fmt::format("column {}", i + 1)) : names[i];
    for (int k = 2; !taken.insert(name).second; ++k)
      name = fmt::format("{} ({})", names[i].empty() ? "column" : names[i], k);
    names[i] = name;
  }
}

// ---- Motive (docs.optitrack.com, Data Export: CSV): line 1 has pairs of key and value, and above the line that begins
// with "Frame" are lines of type, name, ID and quantity.

std::string unit_of_motive(const std::string& name) {
  const std::string text = lower(name);
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
    if (cell(cells, 0) == "Frame") {
      header.axis = std::move(cells);
      header.axis_line = i;
      break;
    }
    if (!is_blank(lines[i])) above.push_back(std::move(cells));
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
  const std::string kind = rotation == header.keys.end() ? "quaternion" : lower(rotation->second);
  std::set<std::string> seen;
  for (std::size_t i = 0; i < form.table.columns.size(); ++i) {
    if (!form.used[i] || cell(header.name, i).empty() || !seen.insert(header.name[i]).second) continue;
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

TableForm motive(std::span<const std::string> lines) {
  const MotiveHeader header = motive_header(lines);
  TableForm form;
  form.table.form = "Motive";
  form.first_row = header.axis_line + 1;
  std::map<std::string, std::size_t> left_out;
  for (std::size_t i = 0; i < header.axis.size(); ++i) {
    const bool is_time = header.axis[i].starts_with("Time");
    const std::string type = lower(cell(header.type, i)), quantity = cell(header.quantity, i);
    const bool is_body = type == "rigid body" && (quantity == "Rotation" || quantity == "Position");
    if (is_time && form.table.time_column.empty()) form.table.time_column = header.axis[i];
    if (i > 0 && !is_time && !is_body && !type.empty())
      ++left_out[is_body || type != "rigid body" ? cell(header.type, i) : "Rigid Body, " + quantity];
    form.used.push_back(is_time || is_body);
    form.table.columns.push_back(is_body ? fmt::format("{}.{}.{}", cell(header.name, i), quantity, header.axis[i])
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

// ---- Vicon (Nexus, Tracker): the section's name, frames per second, bodies, columns, units.

bool is_vicon(std::span<const std::string> lines) {
  constexpr std::string_view kSections[] = {"Segments", "Objects", "Trajectories", "Global Angles"};
  if (lines.size() < 5) return false;
  const std::string name = cell(cells_of(lines[0], ','), 0);
  return std::ranges::find(kSections, name) != std::end(kSections) && is_number_text(cell(cells_of(lines[1], ','), 0));
}

void add_vicon_poses(const Cells& bodies, const Cells& units, TableForm& form) {
  std::set<std::string> seen;
  for (std::size_t i = 2; i < form.table.columns.size(); ++i) {
    const std::string& body = bodies[i];
    if (body.empty() || !seen.insert(body).second) continue;
    const auto has = [&](const std::string& axis) {
      return std::ranges::find(form.table.columns, body + "." + axis) != form.table.columns.end();
    };
    if (!has("TX") || !has("RX")) continue;
    TablePose pose{body,
                   {body + ".TX", body + ".TY", body + ".TZ"},
                   {body + ".RX", body + ".RY", body + ".RZ"},
                   "vector",
                   "mm",
                   "deg",
                   logs::Up::z};
    const auto rotation = std::ranges::find(form.table.columns, body + ".RX") - form.table.columns.begin();
    if (cell(units, static_cast<std::size_t>(rotation)) == "rad") pose.angle_unit = "rad";
    if (has("RW")) {
      pose.rotation.push_back(body + ".RW");
      pose.order = "quaternion";
      pose.angle_unit.clear();
    }
    form.table.poses.push_back(std::move(pose));
  }
}

TableForm vicon(std::span<const std::string> lines) {
  TableForm form;
  form.table.form = "Vicon";
  form.separator = ',';
  const Cells axes = cells_of(lines[3], ','), units = cells_of(lines[4], ',');
  const Cells bodies = filled_forward(cells_of(lines[2], ','), axes.size());
  if (cell(axes, 0) != "Frame") throw RecordingError("an export of Vicon whose fourth line does not begin with Frame");
  for (std::size_t i = 0; i < axes.size(); ++i)
    form.table.columns.push_back(i < 2 || bodies[i].empty() ? axes[i] : bodies[i] + "." + axes[i]);
  make_names_unique(form.table.columns);
  use_all(form);
  form.first_row = 5;
  form.ends_at_blank = true;
  form.frames_per_second = number_in_text(cell(cells_of(lines[1], ','), 0));
  form.frame_column = "Frame";
  add_vicon_poses(bodies, units, form);
  return form;
}

// ---- Qualisys (docs.qualisys.com, TSV export of 6DOF data): keys, then a line of columns, for each body X ... Rot[8].

bool is_qualisys(std::span<const std::string> lines) {
  return lines[0].starts_with("NO_OF_FRAMES");
}

TableForm qualisys(std::span<const std::string> lines) {
  TableForm form;
  form.table.form = "Qualisys";
  form.separator = '\t';
  form.zeros_are_missing = true;
  std::map<std::string, Cells> keys;
  Cells header;
  for (std::size_t i = 0; i < lines.size() && header.empty(); ++i) {
    Cells cells = cells_of(lines[i], '\t');
    const bool has_angles = std::ranges::find(cells, "Roll") != cells.end();
    if (has_angles) {
      header = std::move(cells);
      form.first_row = i + 1;
    } else {
      const std::string key = cell(cells, 0);
      keys[key] = std::move(cells);
    }
  }
  if (header.empty())
    throw RecordingError("an export of Qualisys without columns of Roll, Pitch and Yaw: export 6DOF data");
  const Cells& names = keys["BODY_NAMES"];
  std::size_t body = 0;
  std::string name = "body";
  for (const std::string& axis : header) {
    if (axis == "X" || axis.ends_with(" X"))
      name = cell(names, ++body).empty() ? fmt::format("body {}", body) : names[body];
    const bool of_body = body > 0;
    form.table.columns.push_back(
        !of_body ? axis : name + "." + axis.substr(axis == "X" || !axis.ends_with(" X") ? 0 : axis.size() - 1));
    if (axis == "X" || axis.ends_with(" X"))
      form.table.poses.push_back({name,
                                  {name + ".X", name + ".Y", name + ".Z"},
                                  {name + ".Roll", name + ".Pitch", name + ".Yaw"},
                                  "xyz",
                                  "mm",
                                  "deg",
                                  logs::Up::z});
  }
  while (!form.table.columns.empty() && header[form.table.columns.size() - 1].empty()) form.table.columns.pop_back();
  make_names_unique(form.table.columns);
  use_all(form);
  if (std::ranges::find(form.table.columns, "Time") != form.table.columns.end())
    form.table.time_column = "Time";
  else
    form.frames_per_second = number_in_text(cell(keys["FREQUENCY"], 1));
  if (form.table.time_column.empty() && !form.frames_per_second)
    throw RecordingError("an export of Qualisys without a column Time and without FREQUENCY");
  return form;
}

// ---- TUM (cvg.cit.tum.de, RGB-D dataset: file formats): eight numbers between blanks, comments before them.

bool is_tum(std::span<const std::string> lines) {
  const auto row =
      std::ranges::find_if(lines, [](const std::string& line) { return !is_blank(line) && line[0] != '#'; });
  if (row == lines.end()) return false;
  const Cells words = words_of(*row);
  return words.size() == 8 && std::ranges::all_of(words, is_number_text);
}

TableForm tum(std::span<const std::string> lines) {
  TableForm form;
  form.table.form = "TUM";
  form.separator = ' ';
  form.table.columns = {"timestamp", "tx", "ty", "tz", "qx", "qy", "qz", "qw"};
  form.table.time_column = "timestamp";
  use_all(form);
  form.table.poses.push_back(
      {"trajectory", {"tx", "ty", "tz"}, {"qx", "qy", "qz", "qw"}, "quaternion", "m", "", logs::Up::z});
  form.first_row = 0;
  while (form.first_row < lines.size() && (is_blank(lines[form.first_row]) || lines[form.first_row][0] == '#'))
    ++form.first_row;
  return form;
}

// ---- A line of names, and rows.

// Columns whose names say that they are times, the surest first.
constexpr std::string_view kTimeNames[] = {
    "t_s",     "%time",        "__time",  "time_s",       "time",         "timestamp", "t",
    "stamp",   "secs",         "date",    "datetime",     "elapsed",      "seconds",   "timestamp_s",
    "time_ns", "timestamp_ns", "time_ms", "timestamp_ms", "timestamp_us", "time_us",   "index"};

// "timestamp [ns]" is "timestamp" and "ns".
std::pair<std::string, std::string> name_and_unit(const std::string& column) {
  const std::size_t open = column.find_first_of("[(");
  std::string name = lower(column.substr(0, open));
  while (!name.empty() && name.back() == ' ') name.pop_back();
  std::string unit = open == column.npos ? std::string() : lower(column.substr(open + 1));
  unit = unit.substr(0, unit.find_first_of("])"));
  for (const char* ending : {"ns", "us", "ms"})
    if (unit.empty() && name.ends_with(std::string("_") + ending)) unit = ending;
  return {name, seconds_of_time_unit(unit) ? unit : std::string()};
}

void choose_time(Table& table) {
  std::size_t best = std::size(kTimeNames);
  for (const std::string& column : table.columns) {
    const auto [name, unit] = name_and_unit(column);
    const auto place = static_cast<std::size_t>(std::ranges::find(kTimeNames, name) - std::begin(kTimeNames));
    if (place >= best) continue;
    best = place;
    table.time_column = column;
    table.time_unit = unit;
  }
}

void add_euroc_pose(Table& table) {
  const auto starting = [&table](const std::string& begin) {
    const auto found =
        std::ranges::find_if(table.columns, [&](const std::string& name) { return name.starts_with(begin); });
    return found == table.columns.end() ? std::string() : *found;
  };
  const TablePose pose{"trajectory",
                       {starting("p_RS_R_x"), starting("p_RS_R_y"), starting("p_RS_R_z")},
                       {starting("q_RS_x"), starting("q_RS_y"), starting("q_RS_z"), starting("q_RS_w")},
                       "quaternion",
                       "m",
                       "",
                       logs::Up::z};
  if (std::ranges::find(pose.position, "") == pose.position.end() &&
      std::ranges::find(pose.rotation, "") == pose.rotation.end())
    table.poses.push_back(pose);
}

std::string name_of_form(const Cells& header, bool in_comment) {
  const std::string first = cell(header, 0);
  if (first == "%time") return "CSV of rostopic";
  if (first == "__time") return "CSV of PlotJuggler";
  if (in_comment) return "EuRoC";
  return first.empty() ? "CSV of pandas" : "CSV";
}

// Whether a comment is the header: it names as many columns as the row after it has.
bool is_header_in_comment(std::span<const std::string> lines, std::size_t i) {
  if (!lines[i].starts_with('#') || i + 1 >= lines.size()) return false;
  const Cells names = cells_of(lines[i], ','), row = cells_of(lines[i + 1], ',');
  return names.size() > 1 && names.size() == row.size() && is_number_text(row[0]);
}

TableForm named_columns(std::span<const std::string> lines) {
  TableForm form;
  std::size_t at = 0;
  while (at < lines.size() && (is_blank(lines[at]) || (lines[at].starts_with('#') && !is_header_in_comment(lines, at))))
    ++at;
  if (at == lines.size()) throw RecordingError("it has no line that names the columns");
  const bool in_comment = lines[at].starts_with('#');
  const std::string header = lines[at].substr(in_comment ? lines[at].find_first_not_of("# ") : 0);
  form.separator = runs::separator_of(header, "t_s");
  Cells names = cells_of(header, form.separator);
  if (names.size() < 2 || std::ranges::all_of(names, is_number_text))
    throw RecordingError("its first line does not name columns: write one above the rows, as \"t,x,y\"");
  form.table.form = name_of_form(names, in_comment);
  make_names_unique(names);
  form.table.columns = std::move(names);
  use_all(form);
  form.first_row = at + 1;
  choose_time(form.table);
  if (form.table.form == "CSV of rostopic") form.table.time_unit = "ns";
  add_euroc_pose(form.table);
  return form;
}

template <class Number>
bool take_number(std::string_view& text, std::size_t digits, Number& number) {
  if (text.size() < digits) return false;
  const auto [end, error] = std::from_chars(text.data(), text.data() + digits, number);
  if (error != std::errc{} || end != text.data() + digits) return false;
  text.remove_prefix(digits);
  return true;
}

bool take_mark(std::string_view& text, std::string_view any_of) {
  if (text.empty() || any_of.find(text[0]) == any_of.npos) return false;
  text.remove_prefix(1);
  return true;
}

// "", "Z" or "+02:00", in seconds.
std::optional<double> offset_of_date(std::string_view text) {
  if (text.empty() || text == "Z") return 0;
  const double sign = text[0] == '-' ? -1 : 1;
  unsigned hours = 0, minutes = 0;
  if (!take_mark(text, "+-") || !take_number(text, 2, hours)) return std::nullopt;
  take_mark(text, ":");
  if (!take_number(text, 2, minutes) || !text.empty()) return std::nullopt;
  return sign * (3600.0 * hours + 60.0 * minutes);
}

}  // namespace

TableForm recognise_table(std::span<const std::string> lines) {
  if (lines.empty() || std::ranges::all_of(lines, is_blank)) throw RecordingError("the file is empty");
  if (lines[0].starts_with("Format Version,")) return motive(lines);
  if (is_qualisys(lines)) return qualisys(lines);
  if (is_vicon(lines)) return vicon(lines);
  if (is_tum(lines)) return tum(lines);
  return named_columns(lines);
}

std::optional<double> seconds_of_date(std::string_view text) {
  int year = 0;
  unsigned month = 0, day = 0, hour = 0, minute = 0, second = 0;
  if (!take_number(text, 4, year) || !take_mark(text, "-") || !take_number(text, 2, month) || !take_mark(text, "-") ||
      !take_number(text, 2, day) || !take_mark(text, " T") || !take_number(text, 2, hour) || !take_mark(text, ":") ||
      !take_number(text, 2, minute) || !take_mark(text, ":") || !take_number(text, 2, second))
    return std::nullopt;
  const std::chrono::year_month_day date{std::chrono::year(year), std::chrono::month(month), std::chrono::day(day)};
  if (!date.ok() || hour > 23 || minute > 59 || second > 60) return std::nullopt;
  double fraction = 0;
  if (text.starts_with('.')) {
    const std::size_t end = std::min(text.size(), text.find_first_not_of("0123456789", 1));
    fraction = number_in_text("0" + std::string(text.substr(0, end))).value_or(0);
    text.remove_prefix(end);
  }
  const std::optional<double> offset_s = offset_of_date(text);
  if (!offset_s) return std::nullopt;
  const auto days = std::chrono::sys_days(date).time_since_epoch().count();
  return static_cast<double>(days) * kSecondsPerDay + 3600.0 * hour + 60.0 * minute + second + fraction - *offset_s;
}

}  // namespace kenaf::gap::recordings
