// The outline of a belt: the convex hull of two discs, swept across a width. A main track has two discs of one radius;
// a flipper a large one at its pivot and a small one at its tip; a wheel is one disc, of length 0.
//
// Frame T of a belt: x from disc 0 to disc 1, y across, z up, origin at the centre of disc 0. It is parallel to the
// frame of the body that carries it. Arcs are exact, not polygons, so nothing bumps over corners.
//
// Thread safety: values and pure functions.
#pragma once

#include <array>

#include "physics/dynamics/bullet.hpp"
#include "physics/dynamics/surface.hpp"

namespace kenaf::physics {

struct BeltShape {
  std::array<btScalar, 2> radius{};
  btScalar length = 1;  // between the discs' centres; 0: a wheel, both radii alike
  btScalar half_width;
  btVector3 p_BodyT;  // in the frame of the collision shape
  int pieces;         // of a straight run, which has a contact point at each end of each piece
  Surface surface;

  // Derived. The straight runs' outward unit normals are n = (lean, 0, +-rise). A tangent of both discs has
  // n . c0 + r0 = n . c1 + r1, so lean = (r0 - r1) / length: not vertical where the radii differ.
  btScalar lean = length > 0 ? (radius[0] - radius[1]) / length : 0;
  btScalar rise = btSqrt(1 - lean * lean);

  int discs() const { return length > 0 ? 2 : 1; }
};

// In T, what holds all that can touch the belt; across it, no more than its width.
struct BoundingBox {
  btVector3 low, high;
};
BoundingBox bounding_box(const BeltShape& belt);

// Signed distance from a point of the plane y = 0 to the outline.
struct OutlineDistance {
  btScalar distance;  // negative inside
  btVector3 outward;  // unit normal of the outline at the nearest place, y = 0
};
OutlineDistance distance_to_outline(const BeltShape& belt, btScalar x, btScalar z);

// Support point of a disc in `direction`, a unit vector of the plane y = 0.
inline btVector3 furthest_on_disc(const BeltShape& belt, int disc, const btVector3& direction) {
  return btVector3(disc ? belt.length : 0, 0, 0) + direction * belt.radius[static_cast<std::size_t>(disc)];
}

}  // namespace kenaf::physics
