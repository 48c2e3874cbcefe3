// The shipped worlds with one obstacle, at any size: for searches such as the highest step that is climbed.
//
// Thread safety: pure functions.
#pragma once

#include "physics/world_description.hpp"

namespace kenaf::physics {

// As share/worlds/step-200.sdf: a platform 3 m deep, 2 m wide and `height_m` high on level ground, its face at x = 1 m.
// Throws std::invalid_argument unless the height is from 1 mm to 10 m.
WorldDescription step_world(double height_m);

// As share/worlds/trench-200.sdf: a trench 1 m deep from x = 1 m to 1 m + `width_m` between two platforms with their
// tops at z = 0, 4 m wide, of 6 m and 5 m length. Throws std::invalid_argument unless the width is from 1 mm to 10 m.
WorldDescription trench_world(double width_m);

}  // namespace kenaf::physics
