// Bullet's tables of what is near each other and of what touches, with room from the start: they grow in a step else. Beyond
// this room they still grow.
#pragma once

#include "physics/bullet.hpp"

namespace kenaf::physics {

// Five bodies of a robot in a field of obstacles have about 100 pairs.
class PairTable : public btHashedOverlappingPairCache {
 public:
  PairTable() {
    constexpr int kPairs = 1024;  // a power of two, as the hash wants it
    getOverlappingPairArray().reserve(kPairs);
    m_hashTable.resize(kPairs, BT_NULL_PAIR);
    m_next.resize(kPairs, BT_NULL_PAIR);
  }
};

class Dispatcher : public btCollisionDispatcher {
 public:
  explicit Dispatcher(btCollisionConfiguration* configuration) : btCollisionDispatcher(configuration) {
    constexpr int kManifolds = 1024;
    m_manifoldsPtr.reserve(kManifolds);
  }
};

}  // namespace kenaf::physics
