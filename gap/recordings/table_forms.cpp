#include "gap/recordings/table_forms.hpp"

#include <algorithm>
#include <utility>

#include "formats/runs/csv_cells.hpp"
#include "gap/recordings/capture_forms.hpp"
#include "gap/recordings/recording_error.hpp"
#include "gap/recordings/table_cells.hpp"

namespace kenaf::gap::recordings {
namespace {

// ---- TUM (cvg.cit.tum.de, RGB-D dataset: file formats): eight numbers between blanks, comments before them.

bool is_tum(std::span<const std::string> lines) {
  const auto row =
      std::ranges::find_if(lines, [](const std::string& line) { return !is_blank_line(line) && line[0] != '#'; });
  if (row == lines.end()) return false;
  const Cells words = words_between_blanks(*row);
  return words.size() == 8 && std::ranges::all_of(words, is_number_text);
}

TableForm tum(std::span<const std::string> lines) {
  TableForm form;
  form.table.form = "TUM";
  form.separator = ' ';
  form.table.columns = {"timestamp", "tx", "ty", "tz", "qx", "qy", "qz", "qw"};
  form.table.time_column = "timestamp";
  form.used.assign(form.table.columns.size(), true);
  form.table.poses.push_back(
      {"trajectory", {"tx", "ty", "tz"}, {"qx", "qy", "qz", "qw"}, "quaternion", "m", "", logs::Up::z});
  form.first_row = 0;
  while (form.first_row < lines.size() && (is_blank_line(lines[form.first_row]) || lines[form.first_row][0] == '#'))
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
  std::string name = lower_case(column.substr(0, open));
  while (!name.empty() && name.back() == ' ') name.pop_back();
  std::string unit = open == column.npos ? std::string() : lower_case(column.substr(open + 1));
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
  const std::string first = cell_at(header, 0);
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
  while (at < lines.size() &&
         (is_blank_line(lines[at]) || (lines[at].starts_with('#') && !is_header_in_comment(lines, at))))
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
  form.used.assign(form.table.columns.size(), true);
  form.first_row = at + 1;
  choose_time(form.table);
  if (form.table.form == "CSV of rostopic") form.table.time_unit = "ns";
  add_euroc_pose(form.table);
  return form;
}

}  // namespace

TableForm recognise_table(std::span<const std::string> lines) {
  if (lines.empty() || std::ranges::all_of(lines, is_blank_line)) throw RecordingError("the file is empty");
  if (is_motive(lines)) return motive_form(lines);
  if (is_qualisys(lines)) return qualisys_form(lines);
  if (is_vicon(lines)) return vicon_form(lines);
  if (is_tum(lines)) return tum(lines);
  return named_columns(lines);
}

}  // namespace kenaf::gap::recordings
