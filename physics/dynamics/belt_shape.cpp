#include "physics/dynamics/belt_shape.hpp"

#include <algorithm>

#include "physics/dynamics/touching.hpp"

namespace kenaf::physics {

BoundingBox bounding_box(const BeltShape& belt) {
  const btScalar r = std::max(belt.radius[0], belt.radius[1]) + kTouching_m;
  return {{-belt.radius[0] - kTouching_m, -belt.half_width, -r},
          {belt.length + belt.radius[1] + kTouching_m, belt.half_width, r}};
}

OutlineDistance distance_to_outline(const BeltShape& belt, btScalar x, btScalar z) {
  // Mirrored to the upper half; the upper run has the normal (lean, rise) and the direction (rise, -lean).
  const btScalar lean = belt.lean, rise = belt.rise;
  const btScalar side = z < 0 ? -1 : 1, height = side * z;

  // Beside the straight run: from 0, its end at disc 0, to length * rise, its end at disc 1. Distance n . p - r0.
  const btScalar along = rise * x - lean * height;
  if (along > 0 && along < belt.length * rise)
    return {lean * x + rise * height - belt.radius[0], {lean, 0, side * rise}};

  // Beyond an end of the run: radially from the disc. A point in the middle of a disc is as near to any of its sides.
  const int disc = along > 0;
  const btScalar from_centre = x - (disc ? belt.length : 0);
  const btScalar distance = btSqrt(from_centre * from_centre + z * z);
  const btVector3 outward = distance > 1e-12 ? btVector3(from_centre / distance, 0, z / distance) : btVector3(0, 0, -1);
  return {distance - belt.radius[static_cast<std::size_t>(disc)], outward};
}

}  // namespace kenaf::physics
