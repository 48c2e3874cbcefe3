#include "gap/logs/scale_factor.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "gap/logs/median.hpp"

namespace kenaf::gap::logs {
namespace {

// All chosen. A residual that is this share of the rates is no outlier, however small the others are.
constexpr double kMoving = 0.5, kOutlier = 3 * 1.4826, kLeastOutlier = 0.02, kLeastKept = 0.6, kFewestKept = 15;
constexpr double kMostError = 0.03, kLeastCorrelation = 0.95;

struct PairOfRates {
  double first, second;
};

// Only at times that have a sample, so that a jump of the clock does not add any.
std::vector<PairOfRates> rates_of(const Course& first, const Course& second, double window_s) {
  const double step_s = window_s / kStepsPerWindow;
  std::vector<PairOfRates> rates;
  double next_s = first.t_s.front();
  for (const double t_s : first.t_s) {
    if (t_s < next_s) continue;
    next_s = t_s + step_s;
    const PairOfRates rate{mean_rate(first, t_s, window_s), mean_rate(second, t_s, window_s)};
    if (std::isfinite(rate.first) && std::isfinite(rate.second)) rates.push_back(rate);
  }
  return rates;
}

double root_mean_square(const std::vector<PairOfRates>& rates, double PairOfRates::*of) {
  double sum = 0;
  for (const PairOfRates& rate : rates) sum += rate.*of * rate.*of;
  return std::sqrt(sum / static_cast<double>(rates.size()));
}

}  // namespace

std::optional<ScaleFactor> scale_factor(const Course& first, const Course& second) {
  if (first.t_s.size() < 2 || second.t_s.size() < 2) return std::nullopt;
  const double window_s =
      comparing_window_s(std::max(median_step(first.t_s, first.t_s), median_step(second.t_s, second.t_s)));
  std::vector<PairOfRates> rates = rates_of(first, second, window_s);
  const double still_first = kMoving * root_mean_square(rates, &PairOfRates::first),
               still_second = kMoving * root_mean_square(rates, &PairOfRates::second);
  if (!(still_first > 0) || !(still_second > 0)) return std::nullopt;
  std::erase_if(rates, [&](const PairOfRates& rate) {
    return std::abs(rate.first) <= still_first && std::abs(rate.second) <= still_second;
  });
  const auto moving = static_cast<double>(rates.size());
  if (moving < kFewestKept) return std::nullopt;

  // The median ratio, by the median angle: a ratio has no largest value where the second rests.
  std::vector<double> angles;
  for (const PairOfRates& rate : rates) {
    const double sign = rate.second < 0 ? -1 : 1;
    angles.push_back(std::atan2(sign * rate.first / still_first, sign * rate.second / still_second));
  }
  const double ratio = std::tan(upper_median(angles)) * still_first / still_second;
  if (!(ratio > 0)) return std::nullopt;

  // Outliers go.
  std::vector<double> sizes;
  const auto residual = [ratio](const PairOfRates& rate) { return std::abs(rate.first - ratio * rate.second); };
  for (const PairOfRates& rate : rates) sizes.push_back(residual(rate));
  const double most = std::max(kOutlier * upper_median(sizes), kLeastOutlier * still_first);
  std::erase_if(rates, [&](const PairOfRates& rate) { return residual(rate) > most; });
  const auto kept = static_cast<double>(rates.size());
  if (kept < kFewestKept || kept < kLeastKept * moving) return std::nullopt;

  // The line through zero.
  double aa = 0, bb = 0, ab = 0, sum_a = 0, sum_b = 0, least = INFINITY, largest = 0;
  for (const PairOfRates& rate : rates) {
    aa += rate.first * rate.first, bb += rate.second * rate.second, ab += rate.first * rate.second;
    const double size = std::abs(rate.first);
    sum_a += size, sum_b += std::abs(rate.second);
    least = std::min(least, size), largest = std::max(largest, size);
  }
  const double factor = std::sqrt(aa / bb), correlation = std::min(1.0, ab / std::sqrt(aa * bb));
  if (!(factor > 0) || !std::isfinite(factor) || !(correlation > 0)) return std::nullopt;
  // Windows overlap: one in kStepsPerWindow is independent. The variance of the slope is factor^2 (1 - r^2) / n.
  const double step_s = window_s / kStepsPerWindow;
  return ScaleFactor{factor,         factor * std::sqrt((1 - correlation * correlation) * kStepsPerWindow / kept),
                     correlation,    (largest - least) * kept / sum_a,
                     sum_a * step_s, sum_b * step_s};
}

bool is_certain(const std::optional<ScaleFactor>& factor) {
  return factor && factor->standard_error < kMostError * factor->factor && factor->correlation >= kLeastCorrelation;
}

}  // namespace kenaf::gap::logs
