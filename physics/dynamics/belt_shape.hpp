// The outline of a belt: the convex hull of two discs, swept across a width. A main track has two discs of one radius;
// a flipper a large one at its pivot and a small one at its tip.
//
// Frame T of a belt: x from disc 0 to disc 1, y across, z up, origin at the centre of disc 0. It is parallel to the
// frame of the body that carries it. Exact: no polygon stands for an arc, so nothing bumps over the corners of one.
//
// Thread safety: values and pure functions.
#pragma once

#include <array>

#include "physics/dynamics/bullet.hpp"
#include "physics/dynamics/surface.hpp"

namespace kenaf::physics {

struct BeltShape {
  std::array<btScalar, 2> radius{};
  btScalar length = 1;  // between the discs' centres
  btScalar half_width;
  btVector3 p_BodyT;  // in the frame of the collision shape
  int pieces;         // of a straight run: it touches with a point at each end of each piece
  Surface surface;

  // Follow from the others. The straight runs' outward normals are (lean, 0, +-rise): not vertical where the discs'
  // radii differ.
  btScalar lean = (radius[0] - radius[1]) / length;
  btScalar rise = btSqrt(1 - lean * lean);
};

// The nearest place of the outline to a point of the plane y = 0.
struct OutlineDistance {
  btScalar distance;  // negative inside
  btVector3 outward;  // unit normal of the outline there, y = 0
};
OutlineDistance distance_to_outline(const BeltShape& belt, btScalar x, btScalar z);

// The point of a disc that is the furthest in a direction of the plane y = 0, a unit vector.
inline btVector3 furthest_on_disc(const BeltShape& belt, int disc, const btVector3& direction) {
  return btVector3(disc ? belt.length : 0, 0, 0) + direction * belt.radius[static_cast<std::size_t>(disc)];
}

}  // namespace kenaf::physics
