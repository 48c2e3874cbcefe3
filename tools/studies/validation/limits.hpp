// Static limits of slopes, steps and stairs, against closed forms. Flippers are left out.
#pragma once

#include <vector>

#include "tools/studies/validation/comparison_row.hpp"

namespace kenaf::validation {

std::vector<ComparisonRow> slope_limits();
std::vector<ComparisonRow> step_limits();
std::vector<ComparisonRow> stair_limits();

// The slip of a robot that climbs a slope, as a share of its belts' speed, at shares of the steepest one. Coulomb
// friction has none below the limit.
struct SlipRow {
  double share_of_limit, slip;
};
std::vector<SlipRow> slip_on_slopes();

}  // namespace kenaf::validation
