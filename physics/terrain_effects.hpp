// Effects of the terrain stage on a world's geometry and gravity. Pure; called before a World is made for a robot.
#pragma once

#include "physics/effects.hpp"
#include "physics/world_description.hpp"

namespace kenaf::physics {

// Returns the world with `effects`:
// - obstacle_height raises the upper face of every fixed box, and all of a mesh but its lowest points; at least 1 mm of
//   height remains. All treads of a stair rise alike, so only the first riser gets higher. A loose box is lifted with
//   the box it may stand on, but never lowered: it falls.
// - obstacle_position moves every box and mesh along the world's x.
// - ground_slope and ground_bank turn gravity; the geometry stays.
// Planes never change, nor does a fixed box or mesh below a start pose (x, y within its outline seen from above), since
// the robot starts on it. So for a trench between two boxes the far one moves, and the trench gets wider.
WorldDescription with_terrain_effects(WorldDescription world, const Effects& effects);

}  // namespace kenaf::physics
