#include "gap/recordings/make_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "gap/logs/capture_up.hpp"
#include "gap/logs/course.hpp"
#include "gap/logs/merge_pose.hpp"
#include "gap/recordings/pose_of_samples.hpp"
#include "gap/recordings/recording_error.hpp"
#include "robot/angles.hpp"
#include "robot/columns.hpp"

namespace kenaf::gap::recordings {
namespace {

constexpr double kEmpty = std::numeric_limits<double>::quiet_NaN();
constexpr double kHold_s = 1, kStepsOfGap = 2.5;                // chosen; the latter as of a merged pose
constexpr std::size_t kMostValuesOfRun = std::size_t{1} << 24;  // as read_run() takes

std::vector<double> held(const Samples& samples, std::span<const double> rows_s, double max_gap_s) {
  std::vector<double> values;
  for (const double t : rows_s) {
    const auto after = std::ranges::upper_bound(samples.t_s, t + runs::kSameTime_s);
    const auto count = static_cast<std::size_t>(after - samples.t_s.begin());
    values.push_back(count > 0 && t - samples.t_s[count - 1] <= max_gap_s ? samples.value[count - 1] : kEmpty);
  }
  return values;
}

std::vector<double> interpolated(const Samples& samples, std::span<const double> rows_s,
                                 std::optional<double> max_gap_s, bool wraps) {
  const double gap_s = max_gap_s.value_or(kStepsOfGap * logs::median_step(samples.t_s, samples.t_s));
  logs::Course course{samples.t_s, samples.value, gap_s};
  if (wraps) robot::unwrap(course.value);
  std::vector<double> values;
  for (const double t : rows_s) {
    const double value = logs::value_at(course, t);
    values.push_back(wraps && !std::isnan(value) ? std::remainder(value, 2 * std::numbers::pi) : value);
  }
  return values;
}

// The row nearest to a time. `rows_s` is not empty.
std::size_t nearest_row(std::span<const double> rows_s, double t_s) {
  const auto after = static_cast<std::size_t>(std::ranges::lower_bound(rows_s, t_s) - rows_s.begin());
  if (after == 0) return 0;
  const bool is_before = after == rows_s.size() || t_s - rows_s[after - 1] <= rows_s[after] - t_s;
  return is_before ? after - 1 : after;
}

std::vector<double> in_nearest_rows(const Samples& samples, std::span<const double> rows_s) {
  std::vector<double> values(rows_s.size(), kEmpty), away_s(rows_s.size(), INFINITY);
  if (rows_s.empty()) return values;
  const double half_step_s = 0.5 * logs::median_step(rows_s, rows_s);
  for (std::size_t i = 0; i < samples.t_s.size(); ++i) {
    const std::size_t row = nearest_row(rows_s, samples.t_s[i]);
    const double distance_s = std::abs(rows_s[row] - samples.t_s[i]);
    if (distance_s > half_step_s + runs::kSameTime_s || distance_s >= away_s[row]) continue;
    values[row] = samples.value[i];
    away_s[row] = distance_s;
  }
  return values;
}

// The samples of a source, earlier by their delay and times a factor.
Samples converted(const Collected& collected, const std::string& from, const Timing& timing, double factor) {
  Samples samples = collected.samples.at({from, timing.time});
  for (double& t : samples.t_s) t -= timing.delay_s;
  for (double& value : samples.value) value *= factor;
  return samples;
}

class RunMaker {
 public:
  RunMaker(const Mapping& mapping, const Collected& collected, std::optional<double> gauge_m)
      : mapping_(mapping), collected_(collected), gauge_m_(gauge_m) {}

  MadeRun run() {
    rows_s_ = row_times();
    const std::size_t columns = 1 + mapping_.columns.size() + 2 * mapping_.drives.size() + (mapping_.pose ? 6 : 0);
    if (rows_s_.size() * columns > kMostValuesOfRun)
      throw RecordingError(fmt::format("a run of {} rows and {} columns is too long; take a part with --from and --to",
                                       rows_s_.size(), columns));
    add("t_s", rows_s_);
    for (const ColumnMapping& column : mapping_.columns) add_column(column);
    for (const DriveMapping& drive : mapping_.drives) add_drive(drive);
    if (mapping_.pose) add_pose(*mapping_.pose);
    put_in_order();
    say_what_is_empty();
    // From here on the first row's time is 0.
    std::vector<double>& times = made_.run.values[0];
    for (double& t : times) t -= rows_s_.front();
    return std::move(made_);
  }

 private:
  void add(const std::string& column, std::vector<double> values) {
    made_.run.columns.push_back(column);
    made_.run.values.push_back(std::move(values));
  }

  void add_column(const ColumnMapping& column) {
    const robot::Column* known = robot::find_column(column.column);
    std::vector<double> values = sampled(converted(collected_, column.from, column.timing, column.factor), rows_s_,
                                         column.timing, known != nullptr && known->wraps);
    if (known != nullptr && known->quantity == robot::Quantity::track_command)
      stop_where_it_ended(column.column, column.timing, values);
    add(column.column, std::move(values));
  }

  // A replay repeats a command over empty cells. Where the mapping says for how long one is in force, as a drive's
  // watchdog does, the tracks stop after it.
  void stop_where_it_ended(const std::string& name, const Timing& timing, std::vector<double>& values) {
    if (timing.sampling != Sampling::hold || !timing.max_gap_s) return;
    std::size_t stopped = 0;
    const auto begin = std::ranges::find_if(values, [](double value) { return !std::isnan(value); });
    for (auto value = begin; value != values.end(); ++value) {
      if (!std::isnan(*value)) continue;
      *value = 0;
      ++stopped;
    }
    if (stopped > 0)
      made_.remarks.push_back(
          fmt::format("{}: 0, to stop, in {} rows that are more than max_gap_s = {:.3g} s after "
                      "the command before them",
                      name, stopped, *timing.max_gap_s));
  }

  void add_drive(const DriveMapping& drive) {
    const std::optional<double> gauge_m = drive.gauge_m ? drive.gauge_m : gauge_m_;
    if (!gauge_m) throw RecordingError("a [[drive]] without gauge_m: give it, or the robot by --robot");
    const auto v = sampled(converted(collected_, drive.v, drive.timing, drive.v_factor), rows_s_, drive.timing, false);
    const auto w = sampled(converted(collected_, drive.w, drive.timing, drive.w_factor), rows_s_, drive.timing, false);
    std::vector<double> left(v.size()), right(v.size());
    for (std::size_t i = 0; i < v.size(); ++i) {
      left[i] = v[i] - 0.5 * *gauge_m * w[i];
      right[i] = v[i] + 0.5 * *gauge_m * w[i];
    }
    if (drive.commanded) {
      stop_where_it_ended(columns_of(drive)[0], drive.timing, left);
      stop_where_it_ended(columns_of(drive)[1], drive.timing, right);
    }
    add(columns_of(drive)[0], std::move(left));
    add(columns_of(drive)[1], std::move(right));
  }

  void add_pose(const PoseMapping& pose) {
    PoseOfSamples found = pose_of_samples(pose, collected_);
    made_.remarks.insert(made_.remarks.end(), found.remarks.begin(), found.remarks.end());
    logs::MergeOptions options;
    options.keep_frame = pose.keep_frame;
    options.offset_s = -pose.timing.delay_s;
    options.max_gap_s = pose.timing.max_gap_s;
    check_up(pose, found.capture);
    try {
      logs::MergedRun merged = logs::merge_pose(made_.run, found.capture, options);
      made_.run = std::move(merged.run);
    } catch (const runs::RunFileError& error) {
      throw RecordingError(fmt::format("the [pose]: {}", error.what()));
    }
  }

  // Where the mapping does not say which axis points up.
  void check_up(const PoseMapping& pose, const logs::MotionCapture& capture) const {
    if (pose.up) return;
    if (const auto seen = logs::up_seen(made_.run, capture))
      throw RecordingError(
          fmt::format("the [pose]: its {} axis points up, not z: {}. Write up = \"{}\", or \"z\" if z is "
                      "up nevertheless",
                      logs::name_of(seen->up), seen->why, logs::name_of(seen->up)));
  }

  // The samples whose times are those of the rows.
  Samples samples_of_rows() const {
    for (const ColumnMapping& column : mapping_.columns)
      if (column.column == mapping_.rows) return converted(collected_, column.from, column.timing, 1);
    for (const DriveMapping& drive : mapping_.drives)
      for (const std::string& column : columns_of(drive))
        if (column == mapping_.rows) return converted(collected_, drive.v, drive.timing, 1);
    return converted(collected_, mapping_.pose->position.front(), mapping_.pose->timing, 1);
  }

  std::vector<double> row_times() const {
    if (!mapping_.rows.empty()) {
      Samples samples = samples_of_rows();
      if (samples.t_s.empty())
        throw RecordingError(fmt::format("no value of {}, whose times the rows are to have", mapping_.rows));
      return std::move(samples.t_s);
    }
    double from_s = INFINITY, to_s = -INFINITY;
    for (const auto& [source, samples] : collected_.samples) {
      if (samples.t_s.empty()) continue;
      from_s = std::min(from_s, samples.t_s.front());
      to_s = std::max(to_s, samples.t_s.back());
    }
    if (!(from_s <= to_s)) throw RecordingError("no source of the mapping has a value");
    const double count = std::floor((to_s - from_s) / mapping_.every_s + 1e-9) + 1;
    if (!(count <= static_cast<double>(kMostValuesOfRun)))
      throw RecordingError("so many rows are too many; take a part with --from and --to");
    std::vector<double> times;
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
      times.push_back(from_s + static_cast<double>(i) * mapping_.every_s);
    return times;
  }

  // In the order of robot/columns.hpp.
  void put_in_order() {
    const auto place = [](const std::string& name) {
      const robot::Column* known = robot::find_column(name);
      return known == nullptr ? robot::columns().size() : static_cast<std::size_t>(known - robot::columns().data());
    };
    std::vector<std::size_t> order(made_.run.columns.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return place(made_.run.columns[i]); });
    runs::Run sorted;
    for (const std::size_t i : order) {
      sorted.columns.push_back(made_.run.columns[i]);
      sorted.values.push_back(std::move(made_.run.values[i]));
    }
    made_.run = std::move(sorted);
  }

  void say_what_is_empty() {
    for (std::size_t i = 1; i < made_.run.columns.size(); ++i) {
      const auto empty = std::ranges::count_if(made_.run.values[i], [](double value) { return std::isnan(value); });
      if (empty > 0)
        made_.remarks.push_back(
            fmt::format("{}: {} of {} rows are empty", made_.run.columns[i], empty, made_.run.row_count()));
    }
  }

  const Mapping& mapping_;
  const Collected& collected_;
  std::optional<double> gauge_m_;
  std::vector<double> rows_s_;
  MadeRun made_;
};

}  // namespace

std::vector<double> sampled(const Samples& samples, std::span<const double> rows_s, const Timing& timing, bool wraps) {
  switch (timing.sampling) {
    case Sampling::hold:
      return held(samples, rows_s, timing.max_gap_s.value_or(kHold_s));
    case Sampling::linear:
      return interpolated(samples, rows_s, timing.max_gap_s, wraps);
    case Sampling::nearest:
      return in_nearest_rows(samples, rows_s);
  }
  return {};
}

MadeRun make_run(const Mapping& mapping, const Collected& collected, std::optional<double> gauge_m) {
  return RunMaker(mapping, collected, gauge_m).run();
}

}  // namespace kenaf::gap::recordings
