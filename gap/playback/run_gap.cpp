#include "gap/playback/run_gap.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "gap/diagnose/channels.hpp"

namespace kenaf::gap::playback {
namespace {

constexpr double kUnknownDifference = std::numeric_limits<double>::quiet_NaN();

std::size_t span_at(double t_s) {
  return static_cast<std::size_t>(t_s / kSpan_s + 1e-9);  // sums of 0.01 s may fall short of a span's beginning
}

// The mean difference of a channel in each span.
std::vector<double> span_means(const std::vector<double>& recorded, const std::vector<double>& simulated, bool is_angle,
                               std::span<const double> times_s) {
  std::vector<double> sums(span_at(times_s.back()) + 1, 0);
  std::vector<int> counts(sums.size(), 0);
  for (std::size_t i = 0; i < times_s.size(); ++i) {
    double difference = simulated[i] - recorded[i];
    if (std::isnan(difference)) continue;
    if (is_angle) difference = std::remainder(difference, 2 * std::numbers::pi);
    sums[span_at(times_s[i])] += difference;
    ++counts[span_at(times_s[i])];
  }
  for (std::size_t s = 0; s < sums.size(); ++s) sums[s] = counts[s] > 0 ? sums[s] / counts[s] : kUnknownDifference;
  return sums;
}

// Root of the mean square, without unknown values; NaN if all are unknown.
class RootMeanSquare {
 public:
  void add(double value) {
    if (std::isnan(value)) return;
    squares_ += value * value;
    ++count_;
  }
  double get() const { return count_ > 0 ? std::sqrt(squares_ / count_) : kUnknownDifference; }

 private:
  double squares_ = 0;
  int count_ = 0;
};

// The span in which all channels together are most floors away.
std::optional<WorstMoment> worst_of(const RunGap& gap, std::span<const double> times_s,
                                    const std::map<std::string, Floor>& floors) {
  std::optional<WorstMoment> worst;
  const std::size_t spans = span_at(times_s.back()) + 1;
  for (std::size_t s = 0; s < spans; ++s) {
    WorstMoment moment{std::min((static_cast<double>(s) + 0.5) * kSpan_s, times_s.back()), 0, {}, 0, -1};
    RootMeanSquare all;
    for (const auto& [column, differences] : gap.differences) {
      const double in_floors = differences[s] / floors.at(column).value;
      all.add(in_floors);
      if (std::abs(in_floors) > moment.difference_floors)
        moment.column = column, moment.difference = differences[s], moment.difference_floors = std::abs(in_floors);
    }
    moment.floors = all.get();
    if (!std::isnan(moment.floors) && (!worst || moment.floors > worst->floors)) worst = moment;
  }
  return worst;
}

}  // namespace

std::map<std::string, Floor> floors_of(const std::map<std::string, double>& stated_noise,
                                       const ReportedPlaces* report) {
  std::map<std::string, Floor> floors;
  for (const diagnose::Channel& channel : diagnose::diagnosis_channels()) {
    const std::string column(channel.column);
    Floor floor{channel.resolution, FloorFrom::resolution};
    if (const auto noise = stated_noise.find(column); noise != stated_noise.end() && noise->second > floor.value)
      floor = {noise->second, FloorFrom::stated_noise};
    if (report)
      if (const auto known = report->channel_floor.find(column); known != report->channel_floor.end())
        floor = {known->second, FloorFrom::report};
    floors[column] = floor;
  }
  return floors;
}

RunGap gap_of_run(const PlayedBody& recorded, const PlayedBody& simulated, std::span<const double> times_s,
                  const std::map<std::string, Floor>& floors) {
  RunGap gap;
  if (times_s.empty()) return gap;
  for (const diagnose::Channel& channel : diagnose::diagnosis_channels()) {
    const std::string column(channel.column);
    const auto real = recorded.channels.find(column), sim = simulated.channels.find(column);
    if (real == recorded.channels.end() || sim == simulated.channels.end()) continue;
    std::vector<double> differences = span_means(real->second, sim->second, channel.angle, times_s);
    RootMeanSquare rms;
    for (const double difference : differences) rms.add(difference / floors.at(column).value);
    if (std::isnan(rms.get())) continue;
    gap.floors[column] = rms.get();
    gap.differences[column] = std::move(differences);
  }
  gap.worst = worst_of(gap, times_s, floors);
  return gap;
}

std::string_view floor_name(FloorFrom from) {
  switch (from) {
    case FloorFrom::report:
      return "report";
    case FloorFrom::stated_noise:
      return "stated noise";
    case FloorFrom::resolution:
      break;
  }
  return "resolution";
}

}  // namespace kenaf::gap::playback
