#include "gap/diagnose/left_over_series.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "gap/diagnose/channels.hpp"

namespace kenaf::gap::diagnose {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kUnknownValue = std::numeric_limits<double>::quiet_NaN();
// Reach of a rate to each side, at most twice as much: shorter ones mostly show the pose's noise, longer ones blur
// turns (chosen).
constexpr double kReach_s = 0.25;

constexpr QuantityInfo kQuantities[] = {{Quantity::track_mean, "track speed", "m/s", true},
                                        {Quantity::track_difference, "difference of the track speeds", "m/s", true},
                                        {Quantity::left_track, "left track speed", "m/s", true},
                                        {Quantity::right_track, "right track speed", "m/s", true},
                                        {Quantity::current, "current", "A", true},
                                        {Quantity::battery, "voltage", "V", true},
                                        {Quantity::forward, "forward speed", "m/s", false},
                                        {Quantity::sideways, "sideways speed", "m/s", false},
                                        {Quantity::yaw_rate, "yaw rate", "rad/s", false},
                                        {Quantity::gyro, "yaw rate by gyro", "rad/s", false},
                                        {Quantity::pitch, "pitch", "rad", false},
                                        {Quantity::roll, "roll", "rad", false},
                                        {Quantity::height, "height", "m", false}};

QuantitySeries unknown_series(Index spans) {
  return {VectorXd::Constant(spans, kUnknownValue), VectorXd::Constant(spans, kUnknownValue),
          VectorXd::Constant(spans, kUnknownValue)};
}

// A channel as it is; nothing if it has no bin.
std::optional<QuantitySeries> channel_series(const LeftOverRun& run, std::string_view column) {
  QuantitySeries series = unknown_series(span_count(run));
  bool known = false;
  for (std::size_t b = 0; b < run.features->bins().size(); ++b) {
    const Bin& bin = run.features->bins()[b];
    if (diagnosis_channels()[bin.channel].column != column) continue;
    const auto at = static_cast<Index>(bin.span), i = static_cast<Index>(b);
    series.measured[at] = run.measured[i];
    series.simulated[at] = run.simulated[i];
    series.sigma[at] = run.sigma[i];
    known = true;
  }
  return known ? std::optional(std::move(series)) : std::nullopt;
}

// by_left * left + by_right * right.
QuantitySeries of_both_tracks(const LeftOverRun& run, std::string_view left_column, std::string_view right_column,
                              double by_left, double by_right) {
  const auto left = channel_series(run, left_column), right = channel_series(run, right_column);
  if (!left || !right) return {};
  return {by_left * left->measured + by_right * right->measured,
          by_left * left->simulated + by_right * right->simulated,
          ((by_left * left->sigma).array().square() + (by_right * right->sigma).array().square()).sqrt()};
}

// The spans around `at` between which a rate is taken; nothing if they are too far apart.
std::optional<std::pair<Index, Index>> ends_of_rate(const VectorXd& values, Index at, double span_s) {
  const auto reach = std::max<Index>(1, static_cast<Index>(std::lround(kReach_s / span_s)));
  const auto known = [&](Index step) -> std::optional<Index> {
    for (Index away = reach; away <= 2 * reach; ++away) {
      const Index i = at + step * away;
      if (i >= 0 && i < values.size() && !std::isnan(values[i])) return i;
    }
    return std::nullopt;
  };
  const auto before = known(-1), after = known(1);
  if (!before || !after) return std::nullopt;
  return std::pair(*before, *after);
}

// The body's velocity in its own frame, along x or y; the chord of an arc has the mean of the headings at its ends.
QuantitySeries velocity(const LeftOverRun& run, bool sideways) {
  const auto x = channel_series(run, "x_m"), y = channel_series(run, "y_m"), yaw = channel_series(run, "yaw_rad");
  if (!x || !y || !yaw) return {};
  const double span_s = run.features->span_s();
  const VectorXd together = x->measured + y->measured + yaw->measured;  // NaN if any of them is
  QuantitySeries series = unknown_series(together.size());
  for (Index i = 0; i < together.size(); ++i) {
    const auto ends = ends_of_rate(together, i, span_s);
    if (!ends) continue;
    const Index a = ends->first, b = ends->second;
    const double duration_s = static_cast<double>(b - a) * span_s;

    // displacement rotated by the mean heading, over the duration
    const auto in_body = [&](const VectorXd& of_x, const VectorXd& of_y, const VectorXd& of_yaw) {
      const double heading = (of_yaw[a] + of_yaw[b]) / 2, dx = of_x[b] - of_x[a], dy = of_y[b] - of_y[a];
      const double ahead = std::cos(heading) * dx + std::sin(heading) * dy;
      const double left = -std::sin(heading) * dx + std::cos(heading) * dy;
      return std::pair(ahead / duration_s, left / duration_s);
    };
    const auto [ahead, left] = in_body(x->measured, y->measured, yaw->measured);
    const auto [ahead_sim, left_sim] = in_body(x->simulated, y->simulated, yaw->simulated);

    // noise: that of both positions, and heading noise times the perpendicular velocity
    const double of_place =
        std::hypot(x->sigma[a], x->sigma[b], std::hypot(y->sigma[a], y->sigma[b])) / std::sqrt(2.0) / duration_s;
    const double of_heading = std::hypot(yaw->sigma[a], yaw->sigma[b]) / 2 * (sideways ? ahead : left);
    series.measured[i] = sideways ? left : ahead;
    series.simulated[i] = sideways ? left_sim : ahead_sim;
    series.sigma[i] = std::hypot(of_place, of_heading);
  }
  return series;
}

QuantitySeries yaw_rate(const LeftOverRun& run) {
  const auto yaw = channel_series(run, "yaw_rad");
  if (!yaw) return {};
  const double span_s = run.features->span_s();
  QuantitySeries series = unknown_series(yaw->measured.size());
  for (Index i = 0; i < yaw->measured.size(); ++i) {
    const auto ends = ends_of_rate(yaw->measured, i, span_s);
    if (!ends) continue;
    const Index a = ends->first, b = ends->second;
    const double duration_s = static_cast<double>(b - a) * span_s;
    series.measured[i] = (yaw->measured[b] - yaw->measured[a]) / duration_s;
    series.simulated[i] = (yaw->simulated[b] - yaw->simulated[a]) / duration_s;
    series.sigma[i] = std::hypot(yaw->sigma[a], yaw->sigma[b]) / duration_s;
  }
  return series;
}

}  // namespace

std::span<const QuantityInfo> left_over_quantities() {
  return kQuantities;
}

Index span_count(const LeftOverRun& run) {
  std::size_t spans = 0;
  for (const Bin& bin : run.features->bins()) spans = std::max(spans, bin.span + 1);
  return static_cast<Index>(spans);
}

QuantitySeries series_of(const LeftOverRun& run, Quantity quantity) {
  // one line per quantity; those of both tracks combine two channels, speeds and yaw rate come from the pose
  const auto channel = [&](std::string_view column) { return channel_series(run, column).value_or(QuantitySeries{}); };
  switch (quantity) {
    case Quantity::track_mean:
      return of_both_tracks(run, "track_left_mps", "track_right_mps", 0.5, 0.5);
    case Quantity::track_difference:
      return of_both_tracks(run, "track_left_mps", "track_right_mps", -1, 1);
    case Quantity::left_track:
      return channel("track_left_mps");
    case Quantity::right_track:
      return channel("track_right_mps");
    case Quantity::current:
      return of_both_tracks(run, "track_left_a", "track_right_a", 0.5, 0.5);
    case Quantity::battery:
      return channel("battery_v");
    case Quantity::forward:
      return velocity(run, false);
    case Quantity::sideways:
      return velocity(run, true);
    case Quantity::yaw_rate:
      return yaw_rate(run);
    case Quantity::gyro:
      return channel("gyro_z_radps");
    case Quantity::pitch:
      return channel("pitch_rad");
    case Quantity::roll:
      return channel("roll_rad");
    case Quantity::height:
      return channel("z_m");
  }
  return {};
}

VectorXd column_by_span(const LeftOverRun& run, std::string_view column) {
  const auto values = run.observation->run.column(column), time = run.observation->run.column("t_s");
  if (values.empty()) return {};
  const Index spans = span_count(run);
  VectorXd sum = VectorXd::Zero(spans), count = VectorXd::Zero(spans);
  for (std::size_t row = 0; row < values.size(); ++row) {
    const auto span = static_cast<Index>((time[row] - time.front()) / run.features->span_s() + 1e-6);
    if (std::isnan(values[row]) || span >= spans) continue;
    sum[span] += values[row];
    ++count[span];
  }
  return (count.array() > 0).select(sum.array() / count.array().max(1), kUnknownValue);
}

VectorXd filled(const VectorXd& values) {
  VectorXd result = VectorXd::Zero(values.size());
  Index last = -1;
  for (Index i = 0; i < values.size(); ++i) {
    if (std::isnan(values[i])) continue;
    for (Index gap = last + 1; gap < i; ++gap) {
      const double share = last < 0 ? 1 : static_cast<double>(gap - last) / static_cast<double>(i - last);
      result[gap] = last < 0 ? values[i] : values[last] + share * (values[i] - values[last]);
    }
    result[i] = values[i];
    last = i;
  }
  if (last >= 0) result.tail(values.size() - last - 1).setConstant(values[last]);
  return result;
}

VectorXd rate_of(const VectorXd& values, double span_s) {
  VectorXd result = VectorXd::Constant(values.size(), kUnknownValue);
  for (Index i = 0; i < values.size(); ++i)
    if (const auto ends = ends_of_rate(values, i, span_s))
      result[i] =
          (values[ends->second] - values[ends->first]) / (static_cast<double>(ends->second - ends->first) * span_s);
  return result;
}

}  // namespace kenaf::gap::diagnose
