// Bullet's tables of near pairs and of contacts, with room from the start, so that they do not grow in a step. Beyond
// this room they still grow.
#pragma once

#include "physics/dynamics/bullet.hpp"

namespace kenaf::physics {

// Five bodies of a robot in a field of obstacles have about 100 pairs.
constexpr int kRoomForPairs = 1024;  // a power of two, as the hash requires

// Bullet clears its pools when a world is made, twice. At their usual 4096 pairs (7 MB) this takes as long as a second
// of a robot's simulation.
class CollisionConfiguration : public btDefaultCollisionConfiguration {
 public:
  CollisionConfiguration() : btDefaultCollisionConfiguration(with_room_for_pairs()) {}

 private:
  static btDefaultCollisionConstructionInfo with_room_for_pairs() {
    btDefaultCollisionConstructionInfo info;
    info.m_defaultMaxPersistentManifoldPoolSize = info.m_defaultMaxCollisionAlgorithmPoolSize = kRoomForPairs;
    return info;
  }
};

class PairTable : public btHashedOverlappingPairCache {
 public:
  PairTable() {
    getOverlappingPairArray().reserve(kRoomForPairs);
    m_hashTable.resize(kRoomForPairs, BT_NULL_PAIR);
    m_next.resize(kRoomForPairs, BT_NULL_PAIR);
  }
};

class Dispatcher : public btCollisionDispatcher {
 public:
  explicit Dispatcher(btCollisionConfiguration* configuration) : btCollisionDispatcher(configuration) {
    m_manifoldsPtr.reserve(kRoomForPairs);
  }
};

}  // namespace kenaf::physics
