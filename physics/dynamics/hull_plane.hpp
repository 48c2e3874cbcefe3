// Contacts of a convex hull with an infinite plane: the four lowest vertices of the hull at once.
//
// Bullet's own algorithm finds one vertex in a step and gathers the others while the body rocks, so that loads would
// depend on how the body came to rest.
#pragma once

#include "physics/dynamics/bullet.hpp"

namespace kenaf::physics {

// Makes `dispatcher` use it in contact tests, for convex hulls and static planes in either order. In a step a hull may
// be a belt: there BeltGround decides, and uses create() for other hulls.
class HullPlaneContacts {
 public:
  explicit HullPlaneContacts(btCollisionDispatcher& dispatcher);
  btCollisionAlgorithmCreateFunc& create(bool plane_first) { return plane_first ? create_swapped_ : create_; }

 private:
  struct Create : btCollisionAlgorithmCreateFunc {
    btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                   const btCollisionObjectWrapper* body0,
                                                   const btCollisionObjectWrapper* body1) override;
  };
  Create create_, create_swapped_;
};

}  // namespace kenaf::physics
