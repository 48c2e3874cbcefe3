// The terrain stage's effects on a world's geometry and on its gravity. Pure; what makes a World for a robot calls it.
#pragma once

#include "physics/effects.hpp"
#include "physics/world_description.hpp"

namespace kenaf::physics {

// The world as `effects` have it:
// - obstacle_height raises the upper face of every fixed box, and all of a mesh but its lowest points. What would be
//   lowered below its own bottom keeps 1 mm. A loose box is lifted with what it may stand on, never lowered: it falls.
// - obstacle_position moves every box and mesh along the world's x.
// - ground_slope and ground_bank turn gravity; the geometry stays.
// Planes never change, nor does a fixed box or mesh that has a start pose's x, y within its outline seen from above:
// the robot starts on it. So of a trench between two boxes the far one moves, and the trench gets wider.
WorldDescription with_terrain_effects(WorldDescription world, const Effects& effects);

}  // namespace kenaf::physics
