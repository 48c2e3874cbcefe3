// Round numbers along an axis.
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

// A range around [low, high] that has an extent, whatever the numbers: a little more than what rounding hides.
Range with_extent(Range range);

struct Ticks {
  std::vector<double> at;           // multiples of one step of 1, 2 or 5 times a power of ten, rising
  std::vector<std::string> labels;  // as many decimals as the step has
};

// The ticks within a range, with the smallest step that makes no more than `at_most` >= 2.
Ticks round_ticks(Range range, int at_most);

}  // namespace kenaf::gap::plot
