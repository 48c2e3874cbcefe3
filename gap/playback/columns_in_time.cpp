#include "gap/playback/columns_in_time.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace kenaf::gap::playback {
namespace {

constexpr double kHole_s = 0.25, kUsualSteps = 3;

struct MeasuredCell {
  double t_s, value;
};

// Longest time between cells that is interpolated.
double hole_of(const std::vector<MeasuredCell>& cells) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < cells.size(); ++i) steps.push_back(cells[i].t_s - cells[i - 1].t_s);
  if (steps.empty()) return kHole_s;
  const auto middle = steps.begin() + std::ssize(steps) / 2;
  std::ranges::nth_element(steps, middle);
  return std::max(kHole_s, kUsualSteps * *middle);
}

}  // namespace

std::vector<double> shown_times(std::span<const double> t_s, std::size_t most) {
  if (t_s.empty() || most == 0) return {};
  const std::size_t step = (t_s.size() + most - 1) / most;
  std::vector<double> times;
  for (std::size_t i = 0; i < t_s.size(); i += step) times.push_back(t_s[i] - t_s.front());
  times.back() = std::max(times.back(), t_s[t_s.size() - 1] - t_s.front());
  return times;
}

std::vector<double> column_at(const runs::Run& run, std::string_view column, std::span<const double> times_s) {
  const auto time = run.column("t_s"), values = run.column(column);
  std::vector<MeasuredCell> cells;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!std::isnan(values[i])) cells.push_back({time[i] - time.front(), values[i]});
  if (cells.empty()) return {};
  const bool angle = column.ends_with("roll_rad") || column.ends_with("pitch_rad") || column.ends_with("yaw_rad");
  const double hole_s = hole_of(cells);
  // One pass over both lists: a cell at that time, else interpolated, else unknown.
  std::vector<double> result;
  result.reserve(times_s.size());
  std::size_t next = 0;  // first cell that is not before the time
  for (const double t_s : times_s) {
    while (next < cells.size() && cells[next].t_s < t_s - runs::kSameTime_s) ++next;
    if (next < cells.size() && cells[next].t_s <= t_s + runs::kSameTime_s) {
      result.push_back(cells[next].value);
    } else if (next == 0 || next == cells.size() || cells[next].t_s - cells[next - 1].t_s > hole_s) {
      result.push_back(std::numeric_limits<double>::quiet_NaN());
    } else {
      const MeasuredCell &a = cells[next - 1], &b = cells[next];
      const double way = angle ? std::remainder(b.value - a.value, 2 * std::numbers::pi) : b.value - a.value;
      result.push_back(a.value + way * (t_s - a.t_s) / (b.t_s - a.t_s));
    }
  }
  return result;
}

}  // namespace kenaf::gap::playback
