#include "gap/diagnose/features.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>

#include "gap/diagnose/channels.hpp"
#include "gap/logs/course.hpp"
#include "robot/angles.hpp"

namespace kenaf::gap::diagnose {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
// 74 degrees: beyond it a rotation of the body changes roll and yaw by four times as much or more (chosen).
constexpr double kUpright_rad = 1.3;
constexpr double kLeastApart_m = 0.05;  // of the tracks, to tell how far they turn the body (chosen)

// Rows in which the nose points up or down, by the latest measured pitch.
std::vector<bool> upright_rows(const runs::Run& measured) {
  std::vector<bool> upright(measured.row_count(), false);
  const std::span<const double> pitch_rad = measured.column("pitch_rad");
  for (std::size_t i = 0; i < pitch_rad.size(); ++i)
    upright[i] = std::isnan(pitch_rad[i]) ? i > 0 && upright[i - 1] : std::abs(pitch_rad[i]) > kUpright_rad;
  return upright;
}

// How far the body turned between two times, by its gyro or else by its tracks.
class MeasuredTurn {
 public:
  explicit MeasuredTurn(const runs::Run& run) {
    const std::span<const double> time = run.column("t_s");
    for (const double t_s : time) t_s_.push_back(t_s - time.front());
    gyro_ = of_rate(run.column("gyro_z_radps"));
    for (const char* unit : {"m", "mps"}) {
      const auto left = run.column(std::string("track_left_") + unit),
                 right = run.column(std::string("track_right_") + unit);
      if (left.empty() || right.empty() || !belts_.t_s.empty()) continue;
      std::vector<double> apart(left.size());
      for (std::size_t i = 0; i < apart.size(); ++i) apart[i] = right[i] - left[i];
      belts_ = unit == std::string("m")
                   ? logs::course_of(t_s_, apart, logs::longest_gap_s(logs::median_step(t_s_, apart)))
                   : of_rate(apart);
    }
  }

  // Learns how far the body turns for each metre that the tracks go apart, from the steps of its yaw without a gap:
  // least squares. The tracks must have gone apart at all.
  void learn(std::span<const double> yaw_t_s, std::span<const double> yaw_rad, double longest_gap_s) {
    double sum_aa = 0, sum_ab = 0, way_m = 0;
    for (std::size_t i = 1; i < yaw_rad.size(); ++i) {
      if (yaw_t_s[i] - yaw_t_s[i - 1] > longest_gap_s) continue;
      const double apart_m = logs::value_at(belts_, yaw_t_s[i]) - logs::value_at(belts_, yaw_t_s[i - 1]);
      if (std::isnan(apart_m)) continue;
      sum_aa += apart_m * apart_m;
      sum_ab += apart_m * robot::wrap_angle(yaw_rad[i] - yaw_rad[i - 1]);
      way_m += std::abs(apart_m);
    }
    if (way_m > kLeastApart_m) radpm_ = sum_ab / sum_aa;
  }

  // Not a number where neither was measured all the while.
  double between(double from_s, double to_s) const {
    const double by_gyro = change(gyro_, from_s, to_s);
    return std::isnan(by_gyro) ? radpm_ * change(belts_, from_s, to_s) : by_gyro;
  }

 private:
  logs::Course of_rate(std::span<const double> rate) const {
    return logs::course_of_rate(t_s_, rate, logs::longest_gap_s(logs::median_step(t_s_, rate)));
  }

  // Not a number over a gap of the course itself: what a rate was there is unknown.
  static double change(const logs::Course& course, double from_s, double to_s) {
    const auto first = std::ranges::lower_bound(course.t_s, from_s), last = std::ranges::lower_bound(course.t_s, to_s);
    if (last == course.t_s.end()) return std::nan("");
    for (auto sample = first; sample != last; ++sample)
      if (*(sample + 1) - *sample > course.longest_gap_s) return std::nan("");
    return logs::value_at(course, to_s) - logs::value_at(course, from_s);
  }

  std::vector<double> t_s_;  // from the run's start
  logs::Course gyro_, belts_;
  double radpm_ = std::nan("");
};

// Unwraps a measured yaw. Over a gap the shorter way need not be the one that was taken: there the whole turn is that
// of the gyro, or else of the tracks, if they were measured.
void unwrap_yaw(const runs::Run& run, std::span<const double> t_s, std::span<double> yaw_rad) {
  const double longest_gap_s = logs::longest_gap_s(logs::median_step(t_s, yaw_rad));
  robot::unwrap(yaw_rad);
  std::optional<MeasuredTurn> turn;  // made if it is needed
  double more_rad = 0;               // whole turns in the gaps before
  for (std::size_t i = 1; i < yaw_rad.size(); ++i) {
    if (t_s[i] - t_s[i - 1] > longest_gap_s) {
      if (!turn) {
        turn.emplace(run);
        turn->learn(t_s, yaw_rad, longest_gap_s);
      }
      const double shorter_rad = yaw_rad[i] + more_rad - yaw_rad[i - 1], turned_rad = turn->between(t_s[i - 1], t_s[i]);
      if (!std::isnan(turned_rad)) more_rad += kTurn * std::round((turned_rad - shorter_rad) / kTurn);
    }
    yaw_rad[i] += more_rad;
  }
}

}  // namespace

FeatureMap::FeatureMap(const runs::Run& measured, double span_s, std::span<const std::string> left_out)
    : span_s_(span_s) {
  const std::span<const double> time = measured.column("t_s");
  const std::vector<bool> upright = upright_rows(measured);
  std::vector<double> means;
  for (std::size_t c = 0; c < diagnosis_channels().size(); ++c) {
    // the channel's measured samples, without those in which it says little
    const Channel& channel = diagnosis_channels()[c];
    if (std::ranges::find(left_out, channel.column) != left_out.end()) continue;
    const std::span<const double> column = measured.column(channel.column);
    Series series{c, {}, {}, 0};
    for (std::size_t i = 0; i < column.size(); ++i) {
      if (std::isnan(column[i]) || (channel.level && upright[i])) continue;
      series.t_s.push_back(time[i] - time.front());
      series.value.push_back(column[i]);
    }
    if (series.t_s.empty()) continue;

    // sums by span, in the order of time
    if (channel.column == "yaw_rad")
      unwrap_yaw(measured, series.t_s, series.value);
    else if (channel.angle)
      robot::unwrap(series.value);
    series.interval_s = series.t_s.size() > 1 ? logs::median_step(series.t_s, series.value) : 0;
    for (std::size_t i = 0; i < series.t_s.size(); ++i) {
      // a time on a border belongs to the later span, despite rounding
      const auto span = static_cast<std::size_t>(series.t_s[i] / span_s + 1e-6);
      if (bins_.empty() || bins_.back().channel != c || bins_.back().span != span) {
        bins_.push_back({c, span, 0});
        means.push_back(0);
      }
      ++bins_.back().samples;
      means.back() += series.value[i];
    }
    series_.push_back(std::move(series));
  }

  measured_ = Eigen::Map<const Eigen::VectorXd>(means.data(), static_cast<Eigen::Index>(means.size()));
  for (std::size_t b = 0; b < bins_.size(); ++b)
    measured_[static_cast<Eigen::Index>(b)] /= static_cast<double>(bins_[b].samples);
}

std::vector<double> FeatureMap::simulated_at(const runs::Run& simulated, const Series& series, double late) const {
  // the samples that have a value, with time from the run's start
  const Channel& channel = diagnosis_channels()[series.channel];
  const std::span<const double> time = simulated.column("t_s"), column = simulated.column(channel.column);
  std::vector<double> t_s, value, result(series.t_s.size(), 0.0);
  for (std::size_t i = 0; i < column.size(); ++i) {
    if (std::isnan(column[i])) continue;
    t_s.push_back(time[i] - time.front());
    value.push_back(column[i]);
  }
  if (t_s.empty()) return result;

  // angles are continued past +-pi, on the turn on which the measured one starts
  if (channel.angle) {
    robot::unwrap(value);
    const double turns = std::round((series.value.front() - value.front()) / kTurn);
    for (double& angle : value) angle += kTurn * turns;
  }

  // linear interpolation at the times at which samples were taken; constant beyond both ends
  std::size_t next = 0;
  for (std::size_t i = 0; i < result.size(); ++i) {
    const double taken_s = series.t_s[i] - late * series.interval_s;
    while (next < t_s.size() && t_s[next] < taken_s) ++next;
    if (next == 0)
      result[i] = value.front();
    else if (next == t_s.size())
      result[i] = value.back();
    else {
      const double share = (taken_s - t_s[next - 1]) / (t_s[next] - t_s[next - 1]);
      result[i] = value[next - 1] + share * (value[next] - value[next - 1]);
    }
  }
  return result;
}

Eigen::VectorXd FeatureMap::of(const runs::Run& simulated, double late) const {
  Eigen::VectorXd means = Eigen::VectorXd::Zero(measured_.size());
  Eigen::Index bin = 0;
  for (const Series& series : series_) {
    const std::vector<double> at = simulated_at(simulated, series, late);
    std::size_t in_bin = 0;
    for (const double value : at) {
      if (in_bin == bins_[static_cast<std::size_t>(bin)].samples) {
        ++bin;
        in_bin = 0;
      }
      means[bin] += value;
      ++in_bin;
    }
    ++bin;
  }
  for (std::size_t b = 0; b < bins_.size(); ++b)
    means[static_cast<Eigen::Index>(b)] /= static_cast<double>(bins_[b].samples);
  return means;
}

}  // namespace kenaf::gap::diagnose
