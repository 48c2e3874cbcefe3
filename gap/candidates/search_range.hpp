// Search ranges of numbers. Thread safety: values and pure functions.
#pragma once

#include <algorithm>

namespace kenaf::gap::candidates {

struct SearchRange {
  double min, max;
};

inline SearchRange half_to_twice(double value) {
  return value < 0 ? SearchRange{2 * value, value / 2} : SearchRange{value / 2, 2 * value};
}
inline SearchRange within(SearchRange range, SearchRange limits) {
  return {std::max(range.min, limits.min), std::min(range.max, limits.max)};
}
// The smallest range that contains `range` and `value`.
inline SearchRange with(SearchRange range, double value) {
  return {std::min(range.min, value), std::max(range.max, value)};
}

}  // namespace kenaf::gap::candidates
