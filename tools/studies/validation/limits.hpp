// Limits of slopes, steps and stairs, and the slip of belts that pull, against closed forms. Flippers are left out.
#pragma once

#include <vector>

#include "tools/studies/validation/comparison_row.hpp"

namespace kenaf::validation {

std::vector<ComparisonRow> slope_limits();
std::vector<ComparisonRow> step_limits();
std::vector<ComparisonRow> stair_limits();

// The height of the centre of mass above the ground side of the belts at which a robot on stairs rocks back when a nose
// leaves its rear end.
std::vector<ComparisonRow> stair_balance();

// Slip against pull, with Coulomb's friction and with one that builds up with shear displacement.
std::vector<ComparisonRow> drawbar_pull();

}  // namespace kenaf::validation
