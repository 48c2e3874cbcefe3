#include "physics/dynamics/belt_shape.hpp"

namespace kenaf::physics {

OutlineDistance distance_to_outline(const BeltShape& belt, btScalar x, btScalar z) {
  const btScalar lean = belt.lean, rise = belt.rise;
  const btScalar side = z < 0 ? -1 : 1, height = side * z;
  const btScalar along = rise * x - lean * height;  // along the run, from where its normal passes through disc 0
  if (along > 0 && along < belt.length * rise)
    return {lean * x + rise * height - belt.radius[0], {lean, 0, side * rise}};
  const int disc = along > 0;
  const btScalar from_centre = x - (disc ? belt.length : 0);
  const btScalar distance = btSqrt(from_centre * from_centre + z * z);
  // a point in the middle of a disc is as near to any of its sides
  const btVector3 outward = distance > 1e-12 ? btVector3(from_centre / distance, 0, z / distance) : btVector3(0, 0, -1);
  return {distance - belt.radius[static_cast<std::size_t>(disc)], outward};
}

}  // namespace kenaf::physics
