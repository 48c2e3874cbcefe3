// Ticks at round numbers along an axis.
//
// Thread safety: pure functions.
#pragma once

#include <string>
#include <vector>

namespace kenaf::gap::plot {

struct Range {
  double low, high;
  double span() const { return high - low; }
};

// Returns a range around [low, high] that is at least a little longer than rounding errors.
Range with_extent(Range range);

struct Ticks {
  std::vector<double> at;           // multiples of one step of 1, 2 or 5 times a power of ten, ascending
  std::vector<std::string> labels;  // with as many decimals as the step
};

// Returns the ticks within a range, with the smallest step that gives at most `at_most` >= 2 of them.
Ticks round_ticks(Range range, int at_most);

}  // namespace kenaf::gap::plot
