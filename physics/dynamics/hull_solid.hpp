// Contacts of a convex hull with another or with a box: the nearest points, and if they overlap, the corners of one's
// face clipped by the other's.
//
// The points are those of Bullet's btConvexConvexAlgorithm. Each of its instances has lists of its own for the corners,
// allocated anew when two bodies touch; here all instances share two lists.
#pragma once

#include <BulletCollision/NarrowPhaseCollision/btGjkEpaPenetrationDepthSolver.h>

#include "physics/dynamics/bullet.hpp"

namespace kenaf::physics {

class HullSolidContacts {
 public:
  HullSolidContacts();
  btCollisionAlgorithmCreateFunc& create() { return create_; }

  // Shared by all algorithms.
  struct Shared {
    btGjkEpaPenetrationDepthSolver depth;
    btAlignedObjectArray<btVector3> face_W, clipped_W;  // scratch
  };

 private:
  struct Create : btCollisionAlgorithmCreateFunc {
    Shared shared;
    btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                   const btCollisionObjectWrapper* body0,
                                                   const btCollisionObjectWrapper* body1) override;
  };
  Create create_;
};

}  // namespace kenaf::physics
