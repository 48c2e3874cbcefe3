#include "gap/recordings/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "formats/runs/csv_cells.hpp"
#include "formats/runs/run_file.hpp"
#include "formats/runs/time_stamps.hpp"
#include "formats/runs/whole_file.hpp"
#include "gap/recordings/iso_date.hpp"
#include "gap/recordings/recording_error.hpp"
#include "gap/recordings/table_forms.hpp"

namespace kenaf::gap::recordings {
namespace {

constexpr std::string_view kByteOrderMarkOfTable = "\xEF\xBB\xBF";
// Limits of memory, as of a run (run_file.cpp).
constexpr std::size_t kMostCells = std::size_t{1} << 24, kLongestRow = std::size_t{1} << 20;
constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

// Words that programs write where there is no number.
bool says_nothing(std::string_view text) {
  constexpr std::string_view kNothing[] = {"nan", "NaN", "NAN",  "null", "NULL", "None",
                                           "N/A", "NA",  "-nan", "inf",  "-inf"};
  return text.empty() || std::ranges::find(kNothing, text) != std::end(kNothing);
}

std::optional<double> truth_of(std::string_view text) {
  if (text == "true" || text == "True") return 1;
  if (text == "false" || text == "False") return 0;
  return std::nullopt;
}

struct TextCells {
  std::size_t count = 0;
  std::string first;
};

class TableReader {
 public:
  explicit TableReader(std::string_view name) : name_(name) {}

  void take(std::string_view text) {
    for (std::size_t end; (end = text.find('\n')) != text.npos; text.remove_prefix(end + 1)) {
      begun_.append(text.substr(0, end));
      take_line();
    }
    begun_.append(text);
    if (begun_.size() > kLongestRow) fail("a line is longer than 1 MB");
  }

  Table finish() {
    if (!begun_.empty()) take_line();
    if (!form_) recognise();
    Table& table = form_->table;
    add_time();
    clear_zeros();
    drop_unused();
    add_remarks();
    if (table.row_count() == 0) fail("no rows below the header");
    return std::move(table);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw RecordingError(fmt::format("{}:{}: {}", name_, line_, what));
  }

  void take_line() {
    ++line_;
    std::string_view line = begun_;
    if (line_ == 1 && line.starts_with(kByteOrderMarkOfTable)) line.remove_prefix(kByteOrderMarkOfTable.size());
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (form_) {
      take_row(line);
    } else {
      head_.emplace_back(line);
      if (head_.size() == kMostHeaderLines) recognise();
    }
    begun_.clear();
  }

  void recognise() {
    try {
      form_ = recognise_table(head_);
    } catch (const RecordingError& error) {
      throw RecordingError(fmt::format("{}: {}", name_, error.what()));
    }
    drop_poses_without_columns();
    form_->table.values.resize(form_->table.columns.size());
    texts_.resize(form_->table.columns.size());
    used_ = static_cast<std::size_t>(std::ranges::count(form_->used, true));
    for (std::size_t i = form_->first_row; i < head_.size(); ++i) take_row(head_[i]);
    head_.clear();
  }

  // As of a body that is exported without its rotation, or of two bodies of one name.
  void drop_poses_without_columns() {
    Table& table = form_->table;
    const auto is_missing = [&table](const std::string& name) {
      return std::ranges::find(table.columns, name) == table.columns.end();
    };
    const std::size_t dropped = std::erase_if(table.poses, [&](const TablePose& pose) {
      return std::ranges::any_of(pose.position, is_missing) || std::ranges::any_of(pose.rotation, is_missing);
    });
    if (dropped > 0) table.remarks.push_back(fmt::format("{} bodies lack a column of their pose", dropped));
  }

  void take_row(std::string_view line) {
    const bool is_blank = line.find_first_not_of(" \t") == line.npos;
    if (is_blank && form_->ends_at_blank && rows_ > 0) ended_ = true;
    if (ended_ && !is_blank) ++after_end_;
    if (ended_ || is_blank || line.starts_with('#')) return;
    split(line);
    std::vector<std::vector<double>>& values = form_->table.values;
    if (++rows_ * used_ > kMostCells)
      fail(fmt::format("more than {} cells; cut the file into shorter ones", kMostCells));
    if (cells_.size() != values.size()) ++other_counts_;
    for (std::size_t i = 0; i < values.size(); ++i)
      if (form_->used[i]) values[i].push_back(i < cells_.size() ? number(cells_[i], texts_[i]) : kNoNumber);
  }

  void split(std::string_view line) {
    if (form_->separator != ' ') return runs::split_cells(line, form_->separator, cells_);
    // Any number of blanks between the cells becomes one tab.
    blanks_as_tabs_.clear();
    for (const char c : line)
      if (c != ' ' && c != '\t')
        blanks_as_tabs_ += c;
      else if (!blanks_as_tabs_.empty() && blanks_as_tabs_.back() != '\t')
        blanks_as_tabs_ += '\t';
    if (blanks_as_tabs_.ends_with('\t')) blanks_as_tabs_.pop_back();
    runs::split_cells(blanks_as_tabs_, '\t', cells_);
  }

  double number(const runs::CsvCell& cell, TextCells& texts) {
    if (says_nothing(cell.text)) return kNoNumber;
    if (const auto value = numbers_.read(cell.text)) return *value;
    if (const auto value = truth_of(cell.text)) return *value;
    if (const auto value = seconds_of_date(cell.text)) return *value;
    if (texts.count++ == 0) texts.first = runs::unquoted(cell).substr(0, 40);
    return kNoNumber;
  }

  // A column time_s out of frames where the form has no times.
  void add_time() {
    if (!form_->frames_per_second) return;
    Table& table = form_->table;
    if (!(*form_->frames_per_second > 0)) fail("the frames per second are not positive");
    std::vector<double> times(rows_);
    const std::span<const double> frames = table.column(form_->frame_column);
    for (std::size_t row = 0; row < times.size(); ++row)
      times[row] = (frames.empty() ? static_cast<double>(row) : frames[row]) / *form_->frames_per_second;
    table.columns.emplace_back("time_s");
    table.values.push_back(std::move(times));
    form_->used.push_back(true);
    table.time_column = "time_s";
    table.remarks.push_back(fmt::format("time_s is made of {} at {} in a second", frames.empty() ? "rows" : "frames",
                                        *form_->frames_per_second));
  }

  void clear_zeros() {
    if (!form_->zeros_are_missing) return;
    Table& table = form_->table;
    for (const TablePose& pose : table.poses) {
      std::size_t cleared = 0;
      std::vector<std::vector<double>*> columns;
      for (const std::string& name : pose.position)
        columns.push_back(
            &table.values[static_cast<std::size_t>(std::ranges::find(table.columns, name) - table.columns.begin())]);
      for (std::size_t row = 0; row < rows_; ++row) {
        if (!std::ranges::all_of(columns, [row](const auto* values) { return (*values)[row] == 0; })) continue;
        ++cleared;
        for (auto* values : columns) (*values)[row] = kNoNumber;
      }
      if (cleared > 0)
        table.remarks.push_back(
            fmt::format("{} rows in which {} is at 0, 0, 0 are taken as not seen", cleared, pose.body));
    }
  }

  void drop_unused() {
    Table& table = form_->table;
    for (std::size_t i = table.columns.size(); i-- > 0;) {
      const bool only_text = texts_.size() > i && texts_[i].count > 0 && !runs::any_measured(table.values[i]);
      if (form_->used[i] && !only_text) continue;
      table.columns.erase(table.columns.begin() + static_cast<std::ptrdiff_t>(i));
      table.values.erase(table.values.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }

  void add_remarks() {
    Table& table = form_->table;
    if (form_->separator == ';') table.remarks.emplace_back("semicolons between the cells");
    if (numbers_.mark() == ',') table.remarks.emplace_back("decimal commas");
    std::size_t text_columns = 0, text_cells = 0;
    std::string first;
    for (const TextCells& texts : texts_) {
      if (texts.count == 0) continue;
      if (text_columns++ == 0) first = texts.first;
      text_cells += texts.count;
    }
    if (text_cells > 0)
      table.remarks.push_back(fmt::format("{} cells of text in {} columns are left out, the first is '{}'", text_cells,
                                          text_columns, first));
    if (other_counts_ > 0)
      table.remarks.push_back(fmt::format("{} rows have another count of cells than the header", other_counts_));
    if (after_end_ > 0)
      table.remarks.push_back(fmt::format("{} lines behind the first section are not read", after_end_));
    if (table.time_unit.empty()) table.time_unit = unit_of_times();
  }

  // By the times themselves, where the header does not say.
  std::string unit_of_times() const {
    const auto unit = runs::time_unit(increasing(form_->table.column(form_->table.time_column)));
    if (!unit) return "s";
    return unit->in_a_second == 1e9 ? "ns" : unit->in_a_second == 1e6 ? "us" : "ms";
  }

  static std::vector<double> increasing(std::span<const double> times) {
    std::vector<double> kept;
    for (const double t : times)
      if (!std::isnan(t) && (kept.empty() || t > kept.back())) kept.push_back(t);
    return kept;
  }

  std::string name_;
  std::size_t line_ = 0;
  std::string begun_;              // a line whose end has not come yet
  std::vector<std::string> head_;  // lines until the form is known
  std::optional<TableForm> form_;
  std::vector<runs::CsvCell> cells_;
  std::string blanks_as_tabs_;
  runs::DecimalNumbers numbers_;
  std::vector<TextCells> texts_;     // by column
  std::size_t rows_ = 0, used_ = 0;  // used_: of the cells in a row
  std::size_t other_counts_ = 0, after_end_ = 0;
  bool ended_ = false;
};

}  // namespace

std::span<const double> Table::column(std::string_view name) const {
  const auto found = std::ranges::find(columns, name);
  if (found == columns.end()) return {};
  return values[static_cast<std::size_t>(found - columns.begin())];
}

Table read_table(const std::filesystem::path& file) {
  TableReader reader(file.string());
  runs::read_in_chunks(file, [&reader](std::string_view chunk) { reader.take(chunk); });
  return reader.finish();
}

Table parse_table(std::string_view text, std::string_view name_for_errors) {
  TableReader reader(name_for_errors);
  reader.take(text);
  return reader.finish();
}

std::optional<double> seconds_of_time_unit(std::string_view unit) {
  if (unit == "s") return 1;
  if (unit == "ms") return 1e-3;
  if (unit == "us") return 1e-6;
  if (unit == "ns") return 1e-9;
  return std::nullopt;
}

}  // namespace kenaf::gap::recordings
