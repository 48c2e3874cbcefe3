// Effects of the body stage on a robot's body. Pure.
#pragma once

#include "physics/robot_description.hpp"

namespace kenaf::physics {

// Returns the body with the effects on mass, inertia and centre of mass. Moments of inertia that no rigid body could
// have are accepted.
BodyDescription with_body_effects(BodyDescription body, const Effects& effects);

}  // namespace kenaf::physics
