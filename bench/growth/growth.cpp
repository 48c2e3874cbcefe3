#include "bench/growth/growth.hpp"

#include <fmt/format.h>

#include <cmath>

namespace kenaf::bench {

double last_exponent(const Growth& growth) {
  const Point &a = growth.points.at(growth.points.size() - 2), &b = growth.points.back();
  return std::log(b.cost / a.cost) / std::log(b.amount / a.amount);
}

double fitted_exponent(const Growth& growth) {
  // slope = sum (x - mean x) y / sum (x - mean x) x, with x and y the logarithms
  double mean = 0;
  for (const Point& p : growth.points) mean += std::log(p.amount) / static_cast<double>(growth.points.size());
  double above = 0, below = 0;
  for (const Point& p : growth.points) {
    const double x = std::log(p.amount);
    above += (x - mean) * std::log(p.cost);
    below += (x - mean) * x;
  }
  return above / below;
}

std::string table_head() {
  return "| over | cost at each amount | unit | exponent, all | last two | ought |\n|---|---|---|---|---|---|\n";
}

std::string table_row(const Growth& growth) {
  std::string costs;
  for (const Point& p : growth.points)
    costs += fmt::format("{}{:.4g}: {:.3g}", costs.empty() ? "" : "; ", p.amount, p.cost);
  return fmt::format("| {} | {} | {} | {:.2f} | {:.2f} | {:g} |\n", growth.of, costs, growth.unit,
                     fitted_exponent(growth), last_exponent(growth), growth.ought);
}

}  // namespace kenaf::bench
