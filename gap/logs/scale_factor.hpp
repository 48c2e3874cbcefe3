// By which factor two logs of the same quantity differ, whatever a few false samples say.
//
// Thread safety: pure functions.
#pragma once

#include <optional>

#include "gap/logs/course.hpp"

namespace kenaf::gap::logs {

struct ScaleFactor {
  double factor;          // first = factor * second; positive
  double standard_error;  // of the factor, 1 sigma
  double correlation;     // without subtracting means, of the windows that were kept
  double levels;          // largest less smallest size of `first`'s rates over their mean size: 0 at a constant speed
  double first_change, second_change;  // how far the two went in these windows, to and fro
};

// Whether the standard error is below 3 % of the factor and the correlation at least 0.95 (chosen).
bool is_certain(const std::optional<ScaleFactor>& factor);

// Compares mean rates over windows of comparing_window_s() in which at least one of the two moves faster than half of
// its own root mean square. Windows farther from the median ratio than three times the median distance are left out;
// through the others goes a line through zero that takes both for inexact: factor = sqrt(sum aa / sum bb). Empty if the
// two have opposite signs, if fewer than 15 windows are left, or less than 0.6 of those that moved.
std::optional<ScaleFactor> scale_factor(const Course& first, const Course& second);

}  // namespace kenaf::gap::logs
