#include "gap/logs/offset_refinement.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <vector>

namespace kenaf::gap::logs {
namespace {

// All chosen.
constexpr Eigen::Index kMostFinePoints = 20000;  // at which a refinement compares both rates
constexpr double kUncertain_s = 1;               // standard error from which on a quantity determines no offset
constexpr double kFinest_s = 1e-9;               // least standard error: identical courses leave no residual at all
constexpr double kCorrelatedOver_s = 2;          // residuals farther apart count as independent

using Eigen::ArrayXd;
using Eigen::Index;

// Newey and West's variance of the sum of x: sum over lags k from -most to most of w(k) sum_i x(i) x(i + k), with
// Bartlett's weights w(k) = 1 - |k| / (most + 1), which keep it from becoming negative.
double bartlett_sum(const ArrayXd& x, Index most) {
  double sum = x.square().sum();
  for (Index lag = 1; lag <= std::min(most, x.size() - 1); ++lag) {
    const double weight = 1 - static_cast<double>(lag) / static_cast<double>(most + 1);
    sum += 2 * weight * (x.head(x.size() - lag) * x.tail(x.size() - lag)).sum();
  }
  return sum;
}

// The variance of sum_i slope(i) residual(i) for a stationary residual: sum over lags k of w(k) gamma(k)
// [sum_i slope(i) slope(i + k)], with the autocovariance gamma(k) = sum_i residual(i) residual(i + k) / n and
// Bartlett's weights w(k).
double stationary_variance(const ArrayXd& slope, const ArrayXd& residual, Index most) {
  const Index n = residual.size();
  double sum = slope.square().sum() * residual.square().sum();
  for (Index lag = 1; lag <= std::min(most, n - 1); ++lag) {
    const double weight = 1 - static_cast<double>(lag) / static_cast<double>(most + 1);
    const auto pairs = [&](const ArrayXd& x) { return (x.head(n - lag) * x.tail(n - lag)).sum(); };
    sum += 2 * weight * pairs(slope) * pairs(residual);
  }
  return sum / static_cast<double>(n);
}

}  // namespace

// Least squares for offset and gain in robot(t) = gain capture(t - offset) + residual(t), by Gauss-Newton from
// `start_s`. With sums over all t:
//
//   gain      = sum(robot capture) / sum(capture^2)    eliminated in each iteration
//   slope     = d residual / d offset = gain (derivative - capture sum(derivative capture) / sum(capture^2)), where
//               derivative = d capture / dt; its part along capture is left out, as a change of the gain absorbs it
//   curvature = sum(slope^2)
//   change_s  = -sum(slope residual) / curvature       step of the offset
std::optional<QuantityOffset> refine_offset(const CourseSeenTwice& seen, const RateWindows& windows, double start_s) {
  // Evaluates at the robot's own sample step, at no more than kMostFinePoints times.
  const double window_s = windows.window_s, first_s = seen.robot.t_s.front();
  const double length_s = seen.robot.t_s.back() - first_s;
  const double sample_s = median_step(seen.robot.t_s, seen.robot.value);
  const double step_s = std::max(std::min(windows.step_s, sample_s), length_s / static_cast<double>(kMostFinePoints));
  const auto count = static_cast<Index>(length_s / step_s) + 1;

  double offset_s = start_s, gain = 0;
  ArrayXd residual, slope;
  double curvature = 0, correlation = 0;
  for (int iteration = 0; iteration < 30; ++iteration) {
    // Both rates at the present offset, and the derivative of the captured one by central differences.
    std::vector<double> robot_rates, capture_rates, capture_derivatives;
    for (Index i = 0; i < count; ++i) {
      const double t_s = first_s + static_cast<double>(i) * step_s, there_s = t_s - offset_s;
      const double robot = mean_rate(seen.robot, t_s, window_s), capture = mean_rate(seen.capture, there_s, window_s);
      const double before = mean_rate(seen.capture, there_s - windows.step_s, window_s);
      const double after = mean_rate(seen.capture, there_s + windows.step_s, window_s);
      if (std::isnan(robot + capture + before + after)) continue;
      robot_rates.push_back(robot);
      capture_rates.push_back(capture);
      capture_derivatives.push_back((after - before) / (2 * windows.step_s));
    }
    if (static_cast<double>(robot_rates.size()) * step_s < kShortestOverlap_s) return std::nullopt;
    const auto as_array = [](const std::vector<double>& v) {
      return Eigen::Map<const ArrayXd>(v.data(), static_cast<Index>(v.size()));
    };
    const ArrayXd robot = as_array(robot_rates), capture = as_array(capture_rates),
                  derivative = as_array(capture_derivatives);

    // Gain, residual and its slope.
    const double energy = capture.square().sum();
    if (!(energy > 0)) return std::nullopt;
    gain = (robot * capture).sum() / energy;
    correlation = gain * std::sqrt(energy / robot.square().sum());
    residual = robot - gain * capture;
    slope = gain * (derivative - capture * ((derivative * capture).sum() / energy));
    curvature = slope.square().sum();
    if (!(curvature > 0)) return std::nullopt;

    // Steps are limited to half a window, within which the derivative holds; two windows away is another solution.
    const double change_s = -(slope * residual).sum() / curvature;
    offset_s += std::clamp(change_s, -0.5 * window_s, 0.5 * window_s);
    if (std::abs(offset_s - start_s) > 2 * window_s) return std::nullopt;
    if (std::abs(change_s) < 1e-7) break;
  }

  // Var(offset) = Var(sum(slope residual)) / curvature^2, with the larger of two estimates of the numerator.
  const auto most = std::min(static_cast<Index>(kCorrelatedOver_s / step_s), residual.size() / 4);
  const double variance_s2 =
      std::max(stationary_variance(slope, residual, most), bartlett_sum(slope * residual, most)) /
      (curvature * curvature);
  const bool no_match = gain < seen.least_gain || gain > seen.most_gain || correlation * correlation < kTellsSomething;
  if (no_match || !(variance_s2 < kUncertain_s * kUncertain_s)) return std::nullopt;
  return QuantityOffset{seen.name, offset_s, std::max(kFinest_s, std::sqrt(variance_s2)), gain, correlation, false};
}

}  // namespace kenaf::gap::logs
