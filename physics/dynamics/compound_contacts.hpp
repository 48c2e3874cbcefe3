// Contacts of a compound (a robot's hull with its tracks or wheels) with any other body: those of its pieces, each by
// the dispatcher's algorithm for the two shapes.
//
// Replaces Bullet's own, which allocates lists whenever a compound comes near another body.
#pragma once

#include <cstddef>

#include "physics/dynamics/bullet.hpp"

namespace kenaf::physics {

class CompoundContacts {
 public:
  static constexpr std::size_t kFewPieces = 3;  // of a robot on tracks; more need memory when two bodies come near

  // Makes `dispatcher` use it for compounds with planes, boxes, convex hulls, meshes and compounds.
  explicit CompoundContacts(btCollisionDispatcher& dispatcher);

 private:
  struct Create : btCollisionAlgorithmCreateFunc {
    btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                   const btCollisionObjectWrapper* body0,
                                                   const btCollisionObjectWrapper* body1) override;
  };
  Create create_, create_swapped_;
};

}  // namespace kenaf::physics
