// Contacts of a convex hull with an infinite plane: the hull's own vertices, all of them that touch at once.
//
// Bullet's own algorithm finds one vertex in a step and gathers the others while the body rocks, so that a track's
// load would depend on how it came to stand. A manifold holds four points, so a hull may name groups of points that
// get a manifold each: so a track's load is spread along its belly.
#pragma once

#include <vector>

#include "physics/bullet.hpp"

namespace kenaf::physics {

// Hangs on btConvexHullShape::getUserPointer(); without it all the hull's vertices are one group.
using ContactGroups = std::vector<std::vector<btVector3>>;

// Makes `dispatcher` use it for convex hulls and static planes, in either order.
class HullPlaneContacts {
 public:
  explicit HullPlaneContacts(btCollisionDispatcher& dispatcher);

 private:
  struct Create : btCollisionAlgorithmCreateFunc {
    btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                   const btCollisionObjectWrapper* body0,
                                                   const btCollisionObjectWrapper* body1) override;
  };
  Create create_, create_swapped_;
};

}  // namespace kenaf::physics
