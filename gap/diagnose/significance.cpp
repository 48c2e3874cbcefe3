#include "gap/diagnose/significance.hpp"

#include <algorithm>
#include <cmath>

namespace kenaf::gap::diagnose {

double p_of_squares(double sum, double freedom) {
  if (freedom <= 0) return 1;
  const double spread = 2 / (9 * freedom);
  return 0.5 * std::erfc((std::cbrt(sum / freedom) - (1 - spread)) / std::sqrt(spread) / std::sqrt(2.0));
}

double p_of_largest_square(double square, double count) {
  return std::min(1.0, count * std::erfc(std::sqrt(std::max(0.0, square) / 2)));
}

}  // namespace kenaf::gap::diagnose
