// When a body counts as touching the ground.
#pragma once

#include "physics/dynamics/bullet.hpp"

namespace kenaf::physics {

// The widest gap that counts as contact, for belts and hulls alike: a step may close it.
inline constexpr btScalar kTouching_m = 0.001;

}  // namespace kenaf::physics
