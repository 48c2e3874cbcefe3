#include "gap/plot/axis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace kenaf::gap::plot {

namespace {

std::string label(double value, double step) {
  if (value == 0) return "0";
  if (step < 1e-6 || std::abs(value) >= 1e7) return fmt::format("{:g}", value);
  const int decimals = std::max(0, -static_cast<int>(std::floor(std::log10(step) + 1e-9)));
  return fmt::format("{:.{}f}", value, decimals);
}

}  // namespace

Range with_extent(Range range) {
  const double least = 1e-6 * std::max({std::abs(range.low), std::abs(range.high), 1e-3});
  if (range.span() >= least) return range;
  const double middle = (range.low + range.high) / 2;
  return {middle - least, middle + least};
}

Ticks round_ticks(Range range, int at_most) {
  range = with_extent(range);
  double power = std::pow(10, std::floor(std::log10(range.span() / at_most)));
  for (;; power *= 10) {
    for (const double factor : {1.0, 2.0, 5.0}) {
      const double step = factor * power;
      // With a tolerance, so that round ends of the range are ticks.
      const double first = std::ceil(range.low / step - 1e-9), last = std::floor(range.high / step + 1e-9);
      if (last - first + 1 > at_most) continue;
      Ticks ticks;
      for (int i = 0; i <= static_cast<int>(last - first); ++i) {
        ticks.at.push_back((first + i) * step);
        ticks.labels.push_back(label(ticks.at.back(), step));
      }
      return ticks;
    }
  }
}

}  // namespace kenaf::gap::plot
