// The body stage's effects on a robot's body. Pure.
#pragma once

#include "physics/robot_description.hpp"

namespace kenaf::physics {

// Mass, inertia and centre of mass as `effects` have them. Moments that no rigid body has together are taken as they
// are.
BodyDescription with_body_effects(BodyDescription body, const Effects& effects);

}  // namespace kenaf::physics
