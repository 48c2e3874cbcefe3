#include "gap/challenge/figure.hpp"

#include <algorithm>
#include <cmath>

namespace kenaf::gap::challenge {
namespace {

constexpr double kTwoSided95 = 1.96;

}  // namespace

Share wilson(std::size_t hits, std::size_t cases) {
  if (cases == 0) return {0, 0, 1};
  const double n = static_cast<double>(cases), p = static_cast<double>(hits) / n, z2 = kTwoSided95 * kTwoSided95;

  // (p + z^2 / 2n +- z sqrt(p (1 - p) / n + z^2 / 4n^2)) / (1 + z^2 / n)
  const double middle = (p + z2 / (2 * n)) / (1 + z2 / n);
  const double half = kTwoSided95 / (1 + z2 / n) * std::sqrt(p * (1 - p) / n + z2 / (4 * n * n));
  return {p, std::max(0.0, middle - half), std::min(1.0, middle + half)};
}

Figure share_figure(std::string_view id, std::string_view what, std::string_view target, const Count& count,
                    double least, double most) {
  const Share share = wilson(count.hits, count.cases);
  return {id,          what,       target,   count.cases,
          share.value, share.from, share.to, count.cases > 0 && share.value >= least && share.value <= most,
          true,        count.hits};
}

Figure difference_figure(std::string_view id, std::string_view what, std::string_view target,
                         const std::vector<double>& differences, double most) {
  Figure figure{id, what, target, differences.size()};
  if (differences.empty()) return figure;
  const auto n = static_cast<double>(differences.size());
  double sum = 0, squares = 0;
  for (const double d : differences) sum += std::abs(d);
  figure.value = sum / n;
  for (const double d : differences) squares += (std::abs(d) - figure.value) * (std::abs(d) - figure.value);

  // mean +- 1.96 s / sqrt(n)
  const double half = n > 1 ? kTwoSided95 * std::sqrt(squares / (n - 1) / n) : figure.value;
  figure.from = std::max(0.0, figure.value - half);
  figure.to = figure.value + half;
  figure.met = figure.value <= most;
  return figure;
}

Figure median_figure(std::string_view id, std::string_view what, std::string_view target, std::vector<double> values,
                     double least, double most) {
  Figure figure{id, what, target, values.size()};
  if (values.empty()) return figure;
  std::ranges::sort(values);
  const auto n = static_cast<double>(values.size());
  const auto at = [&](double rank) { return values[static_cast<std::size_t>(std::clamp(rank, 0.0, n - 1))]; };

  // The number of values below the median is binomial with mean n / 2 and standard deviation sqrt(n) / 2.
  const double half = kTwoSided95 * std::sqrt(n) / 2;
  figure.value = (at(std::floor((n - 1) / 2)) + at(std::ceil((n - 1) / 2))) / 2;
  figure.from = at(std::floor(n / 2 - half));
  figure.to = at(std::ceil(n / 2 + half));
  figure.met = figure.value >= least && figure.value <= most;
  return figure;
}

}  // namespace kenaf::gap::challenge
