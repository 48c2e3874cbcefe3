// How fast robots turn on the spot, against measurements and closed forms.
#pragma once

#include <vector>

#include "tools/studies/validation/comparison_row.hpp"

namespace kenaf::validation {

// Effective widths of real robots, which no number of their descriptions was fitted to: the distance between slipless
// wheels or tracks that would turn the robot as fast.
std::vector<ComparisonRow> turns_of_real_robots();

// The turn rate at which the moment of isotropic Coulomb friction vanishes, under tracks of uniform pressure and under
// wheels.
std::vector<ComparisonRow> turns_by_closed_form();

}  // namespace kenaf::validation
