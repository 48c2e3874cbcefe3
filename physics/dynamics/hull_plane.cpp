#include "physics/dynamics/hull_plane.hpp"

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/CollisionDispatch/btManifoldResult.h>

#include <algorithm>
#include <array>
#include <new>

#include "physics/dynamics/touching.hpp"

namespace kenaf::physics {
namespace {

class HullPlaneAlgorithm : public btCollisionAlgorithm {
 public:
  HullPlaneAlgorithm(const btCollisionAlgorithmConstructionInfo& info, const btCollisionObjectWrapper* body0,
                     const btCollisionObjectWrapper* body1, bool swapped)
      : btCollisionAlgorithm(info), swapped_(swapped) {
    const btCollisionObject *object0 = body0->getCollisionObject(), *object1 = body1->getCollisionObject();
    if (!m_dispatcher->needsCollision(object0, object1)) return;
    manifold_ = m_dispatcher->getNewManifold(object0, object1);
  }
  ~HullPlaneAlgorithm() override {
    if (manifold_) m_dispatcher->releaseManifold(manifold_);
  }

  void processCollision(const btCollisionObjectWrapper* body0, const btCollisionObjectWrapper* body1,
                        const btDispatcherInfo&, btManifoldResult* result) override {
    if (!manifold_) return;
    // The plane in the hull's frame: n . p + offset is the distance of a vertex.
    const btCollisionObjectWrapper& hull = swapped_ ? *body1 : *body0;
    const btCollisionObjectWrapper& plane_wrap = swapped_ ? *body0 : *body1;
    const auto& plane = *static_cast<const btStaticPlaneShape*>(plane_wrap.getCollisionShape());
    const btVector3 normal_W = plane_wrap.getWorldTransform().getBasis() * plane.getPlaneNormal();
    const btTransform X_PH = plane_wrap.getWorldTransform().inverseTimes(hull.getWorldTransform());
    const btVector3 normal_H = X_PH.getBasis().transpose() * plane.getPlaneNormal();
    const btScalar offset = plane.getPlaneNormal().dot(X_PH.getOrigin()) - plane.getPlaneConstant();

    // A contact point for each of the lowest vertices.
    const auto& shape = *static_cast<const btConvexHullShape*>(hull.getCollisionShape());
    const btVector3* points = shape.getUnscaledPoints();
    const Deepest deepest = find_deepest(points, static_cast<std::size_t>(shape.getNumPoints()), normal_H, offset);
    result->setPersistentManifold(manifold_);
    for (std::size_t i = 0; i < deepest.count; ++i) {
      const btScalar distance = deepest.point[i].distance;
      const btVector3 on_hull_W = hull.getWorldTransform() * points[deepest.point[i].index];
      // btManifoldResult expects normal and point on the second body.
      if (swapped_)
        result->addContactPoint(-normal_W, on_hull_W, distance);
      else
        result->addContactPoint(normal_W, on_hull_W - normal_W * distance, distance);
    }
    if (manifold_->getNumContacts()) result->refreshContactPoints();
  }

  btScalar calculateTimeOfImpact(btCollisionObject*, btCollisionObject*, const btDispatcherInfo&,
                                 btManifoldResult*) override {
    return 1;
  }
  void getAllContactManifolds(btManifoldArray& manifolds) override {
    if (manifold_) manifolds.push_back(manifold_);
  }

 private:
  struct Deepest {
    struct Point {
      btScalar distance;
      std::size_t index;
    };
    std::array<Point, 4> point;
    std::size_t count = 0;
  };

  // The four vertices of least distance within kTouching_m, in the order of the hull's vertices.
  static Deepest find_deepest(const btVector3* points, std::size_t count, const btVector3& normal, btScalar offset) {
    Deepest found;
    for (std::size_t i = 0; i < count; ++i) {
      const btScalar distance = normal.dot(points[i]) + offset;
      if (distance > kTouching_m) continue;
      if (found.count < found.point.size()) {
        found.point[found.count++] = {distance, i};
        continue;
      }
      auto& shallowest = *std::max_element(found.point.begin(), found.point.end(),
                                           [](const auto& a, const auto& b) { return a.distance < b.distance; });
      if (distance < shallowest.distance) shallowest = {distance, i};
    }
    return found;
  }

  btPersistentManifold* manifold_ = nullptr;
  bool swapped_;
};

}  // namespace

btCollisionAlgorithm* HullPlaneContacts::Create::CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                                          const btCollisionObjectWrapper* body0,
                                                                          const btCollisionObjectWrapper* body1) {
  void* memory = info.m_dispatcher1->allocateCollisionAlgorithm(sizeof(HullPlaneAlgorithm));
  return m_swapped ? new (memory) HullPlaneAlgorithm(info, body0, body1, true)
                   : new (memory) HullPlaneAlgorithm(info, body0, body1, false);
}

HullPlaneContacts::HullPlaneContacts(btCollisionDispatcher& dispatcher) {
  create_swapped_.m_swapped = true;
  dispatcher.registerClosestPointsCreateFunc(CONVEX_HULL_SHAPE_PROXYTYPE, STATIC_PLANE_PROXYTYPE, &create_);
  dispatcher.registerClosestPointsCreateFunc(STATIC_PLANE_PROXYTYPE, CONVEX_HULL_SHAPE_PROXYTYPE, &create_swapped_);
}

}  // namespace kenaf::physics
