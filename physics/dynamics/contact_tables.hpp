// Bullet's tables of near pairs and of contacts, with room from the start, so that they do not grow in a step. Beyond
// this room they still grow, the pairs of boxes up to a limit.
#pragma once

#include <cstdint>

#include "physics/dynamics/bullet.hpp"
#include "physics/dynamics/bullet_memory.hpp"
#include "physics/world_values.hpp"

namespace kenaf::physics {

// Five bodies of a robot in a field of obstacles have about 100 pairs. Tables for four times as many make a step of a
// robot that stands 1.3 % slower.
constexpr int kRoomForPairs = 1024;

// The bit of boxes in Bullet's filter groups, beside that of what moves or is fixed.
constexpr int kBoxes = 64;
static_assert(kBoxes > btBroadphaseProxy::CharacterFilter, "a bit that Bullet does not use");

// Bullet clears its pools when a world is made, twice. At their usual 4096 pairs (7 MB) this takes as long as a second
// of a robot's simulation.
class CollisionConfiguration : public btDefaultCollisionConfiguration {
 public:
  CollisionConfiguration() : btDefaultCollisionConfiguration(with_room_for_pairs()) {}

 private:
  static btDefaultCollisionConstructionInfo with_room_for_pairs() {
    have_bullet_throw();  // before a world's first allocation
    btDefaultCollisionConstructionInfo info;
    info.m_defaultMaxPersistentManifoldPoolSize = info.m_defaultMaxCollisionAlgorithmPoolSize = kRoomForPairs;
    return info;
  }
};

class PairTable : public btHashedOverlappingPairCache {
 public:
  PairTable() {
    static_assert((kRoomForPairs & (kRoomForPairs - 1)) == 0, "a power of two, as the hash requires");
    getOverlappingPairArray().reserve(kRoomForPairs);
    m_hashTable.resize(kRoomForPairs, BT_NULL_PAIR);
    m_next.resize(kRoomForPairs, BT_NULL_PAIR);
  }

  // Bounds the time of a step: once there are `kMostPairs`, further ones of boxes are left out, except with the ground,
  // so that no box falls through it. Bullet offers a pair again once one of the two has moved by some centimetres.
  btBroadphasePair* addOverlappingPair(btBroadphaseProxy* a, btBroadphaseProxy* b) override {
    if (static_cast<std::size_t>(getNumOverlappingPairs()) < kMostPairs || !is_of_boxes(*a, *b)) {
      return btHashedOverlappingPairCache::addOverlappingPair(a, b);
    }
    if (!needsBroadphaseCollision(a, b)) return nullptr;
    btBroadphasePair* known = findPair(a, b);
    if (known == nullptr) ++left_out_;
    return known;
  }
  std::uint64_t left_out() const { return left_out_; }  // so far

 private:
  static bool is_of_boxes(const btBroadphaseProxy& a, const btBroadphaseProxy& b) {
    const auto is_box = [](const btBroadphaseProxy& proxy) { return (proxy.m_collisionFilterGroup & kBoxes) != 0; };
    const auto is_ground = [&](const btBroadphaseProxy& proxy) {
      return (proxy.m_collisionFilterGroup & btBroadphaseProxy::StaticFilter) != 0 && !is_box(proxy);
    };
    return (is_box(a) || is_box(b)) && !is_ground(a) && !is_ground(b);
  }

  std::uint64_t left_out_ = 0;
};

class Dispatcher : public btCollisionDispatcher {
 public:
  explicit Dispatcher(btCollisionConfiguration* configuration) : btCollisionDispatcher(configuration) {
    m_manifoldsPtr.reserve(kRoomForPairs);
  }
};

}  // namespace kenaf::physics
