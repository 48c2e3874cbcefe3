// Refines the offset of two clocks for one quantity, from a start that is right to about a window.
//
// Thread safety: pure functions.
#pragma once

#include <optional>

#include "gap/logs/clock_offset.hpp"

namespace kenaf::gap::logs {

// Limits that the search shares. Both chosen.
inline constexpr double kShortestOverlap_s = 1;  // of a quantity in both logs, for an offset to count
inline constexpr double kTellsSomething = 0.5;   // least r squared of a quantity that counts

// Rates are means over windows that begin a step apart.
struct RateWindows {
  double window_s, step_s;
};

// Least squares for offset and gain, with the standard error that clock_offset.hpp describes; `used` is false. Empty if
// it leaves the neighbourhood of the start, finds no motion, fits badly or leaves the offset uncertain.
std::optional<QuantityOffset> refine_offset(const CourseSeenTwice& seen, const RateWindows& windows, double start_s);

}  // namespace kenaf::gap::logs
