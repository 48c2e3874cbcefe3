// The median of a few numbers.
//
// Thread safety: a pure function.
#pragma once

#include <algorithm>
#include <iterator>
#include <vector>

namespace kenaf::gap::logs {

// Returns the upper median: of an even count the larger of the middle two. `values` must not be empty or hold a NaN.
inline double upper_median(std::vector<double> values) {
  const auto middle = values.begin() + std::ssize(values) / 2;
  std::ranges::nth_element(values, middle);
  return *middle;
}

}  // namespace kenaf::gap::logs
