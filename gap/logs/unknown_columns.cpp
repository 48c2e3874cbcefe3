#include "gap/logs/unknown_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "formats/settings/nearest_word.hpp"
#include "robot/columns.hpp"

namespace kenaf::gap::logs {
namespace {

// Without those that only the recorder of the robot's library writes.
const std::vector<std::string>& known_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const robot::Column& column : robot::columns())
      if (column.quantity != robot::Quantity::time && column.quantity < robot::Quantity::robot_time)
        all.emplace_back(column.name);
    return all;
  }();
  return names;
}

// "gyro_z" of "gyro_z_radps".
std::string_view without_unit(std::string_view name) {
  return name.substr(0, std::min(name.rfind('_'), name.size()));
}

// The known column that was probably meant by an unknown one; empty if none, or if the run has it.
std::string meant_by(const std::string& name, const runs::Run& run) {
  const auto is_there = [&run](std::string_view known) { return std::ranges::count(run.columns, known) > 0; };
  bool is_other_unit = false;
  for (const std::string& known : known_names()) {
    if (without_unit(known) != without_unit(name)) continue;
    if (!is_there(known)) return known;
    is_other_unit = true;
  }
  const std::string_view nearest = is_other_unit ? "" : settings::nearest_word(name, known_names());
  return nearest.empty() || is_there(nearest) ? "" : std::string(nearest);
}

}  // namespace

void UnknownColumns::look_at(const runs::Run& run, const std::string& file) {
  bool any = false;
  for (const std::string& name : run.columns) {
    if (robot::find_column(name) != nullptr) continue;
    const std::string meant = meant_by(name, run);
    if (meant.empty()) continue;
    any = true;
    if (file_.empty()) file_ = file;
    if (std::ranges::find(unknown_, name, &Unknown::name) == unknown_.end()) unknown_.push_back({name, meant});
  }
  if (any) ++files_;
}

std::vector<Finding> UnknownColumns::findings() const {
  if (unknown_.empty()) return {};
  std::string others;
  for (std::size_t i = 1; i < unknown_.size(); ++i)
    others += fmt::format("{}{} ({}?)", i == 1 ? "; nor are " : ", ", unknown_[i].name, unknown_[i].meant);
  return {{Finding::Severity::warn, file_, 0, unknown_.front().name,
           fmt::format("is no known column and not used; did you mean {}? Its name says its unit{}{}",
                       unknown_.front().meant, others, files_ > 1 ? fmt::format(" (as in {} more)", files_ - 1) : "")}};
}

}  // namespace kenaf::gap::logs
