#include "physics/hull_plane.hpp"

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/CollisionDispatch/btManifoldResult.h>

#include <algorithm>
#include <array>
#include <new>

namespace kenaf::physics {
namespace {

constexpr btScalar kTouching_m = 0.001;  // a gap that a step may close

class HullPlaneAlgorithm : public btCollisionAlgorithm {
 public:
  HullPlaneAlgorithm(const btCollisionAlgorithmConstructionInfo& info, const btCollisionObjectWrapper* hull,
                     const btCollisionObjectWrapper* plane, bool swapped)
      : btCollisionAlgorithm(info), swapped_(swapped) {
    if (m_dispatcher->needsCollision(hull->getCollisionObject(), plane->getCollisionObject())) {
      manifold_ = m_dispatcher->getNewManifold(swapped ? plane->getCollisionObject() : hull->getCollisionObject(),
                                               swapped ? hull->getCollisionObject() : plane->getCollisionObject());
    }
  }
  ~HullPlaneAlgorithm() override {
    if (manifold_) m_dispatcher->releaseManifold(manifold_);
  }

  void processCollision(const btCollisionObjectWrapper* body0, const btCollisionObjectWrapper* body1,
                        const btDispatcherInfo&, btManifoldResult* result) override {
    if (!manifold_) return;
    const btCollisionObjectWrapper& hull_wrap = swapped_ ? *body1 : *body0;
    const btCollisionObjectWrapper& plane_wrap = swapped_ ? *body0 : *body1;
    const auto& hull = *static_cast<const btConvexHullShape*>(hull_wrap.getCollisionShape());
    const auto& plane = *static_cast<const btStaticPlaneShape*>(plane_wrap.getCollisionShape());
    const btTransform X_PH = plane_wrap.getWorldTransform().inverseTimes(hull_wrap.getWorldTransform());
    const btVector3 normal_H = X_PH.getBasis().transpose() * plane.getPlaneNormal();
    const btScalar offset = plane.getPlaneNormal().dot(X_PH.getOrigin()) - plane.getPlaneConstant();

    // the deepest four
    struct Vertex {
      btScalar distance;
      int index;
    };
    std::array<Vertex, 4> found;
    std::size_t count = 0;
    for (int i = 0; i < hull.getNumPoints(); ++i) {
      const btScalar distance = normal_H.dot(hull.getUnscaledPoints()[i]) + offset;
      if (distance > kTouching_m) continue;
      if (count == found.size()) {
        const auto shallowest = std::max_element(
            found.begin(), found.end(), [](const Vertex& a, const Vertex& b) { return a.distance < b.distance; });
        if (distance < shallowest->distance) *shallowest = {distance, i};
      } else {
        found[count++] = {distance, i};
      }
    }
    result->setPersistentManifold(manifold_);
    const btVector3 normal_W = plane_wrap.getWorldTransform().getBasis() * plane.getPlaneNormal();
    for (std::size_t i = 0; i < count; ++i) {
      const btVector3 on_hull_W = hull_wrap.getWorldTransform() * hull.getUnscaledPoints()[found[i].index];
      // a result wants the normal on the second body and the point on it
      if (swapped_)
        result->addContactPoint(-normal_W, on_hull_W, found[i].distance);
      else
        result->addContactPoint(normal_W, on_hull_W - normal_W * found[i].distance, found[i].distance);
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
  btPersistentManifold* manifold_ = nullptr;
  bool swapped_;
};

}  // namespace

btCollisionAlgorithm* HullPlaneContacts::Create::CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                                          const btCollisionObjectWrapper* body0,
                                                                          const btCollisionObjectWrapper* body1) {
  void* memory = info.m_dispatcher1->allocateCollisionAlgorithm(sizeof(HullPlaneAlgorithm));
  return m_swapped ? new (memory) HullPlaneAlgorithm(info, body1, body0, true)
                   : new (memory) HullPlaneAlgorithm(info, body0, body1, false);
}

HullPlaneContacts::HullPlaneContacts(btCollisionDispatcher& dispatcher) {
  create_swapped_.m_swapped = true;
  dispatcher.registerCollisionCreateFunc(CONVEX_HULL_SHAPE_PROXYTYPE, STATIC_PLANE_PROXYTYPE, &create_);
  dispatcher.registerCollisionCreateFunc(STATIC_PLANE_PROXYTYPE, CONVEX_HULL_SHAPE_PROXYTYPE, &create_swapped_);
  dispatcher.registerClosestPointsCreateFunc(CONVEX_HULL_SHAPE_PROXYTYPE, STATIC_PLANE_PROXYTYPE, &create_);
  dispatcher.registerClosestPointsCreateFunc(STATIC_PLANE_PROXYTYPE, CONVEX_HULL_SHAPE_PROXYTYPE, &create_swapped_);
}

}  // namespace kenaf::physics
