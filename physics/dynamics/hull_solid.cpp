#include "physics/dynamics/hull_solid.hpp"

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/CollisionDispatch/btConvexConvexAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btManifoldResult.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkPairDetector.h>
#include <BulletCollision/NarrowPhaseCollision/btPolyhedralContactClipping.h>
#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>

#include <new>

namespace kenaf::physics {
namespace {

constexpr int kManyCorners = 256;  // of a face, and after clipping; a track's side has 34

// Removes the margins by which Bullet rounds shapes: a hull's corners lie inside of them.
struct WithoutMargins : btDiscreteCollisionDetectorInterface::Result {
  btManifoldResult& result;
  btScalar margin_a, margin_b;
  btScalar gap = 1;  // if nothing is near
  btVector3 normal_W{0, 0, 0};

  WithoutMargins(btManifoldResult& to, btScalar of_a, btScalar of_b) : result(to), margin_a(of_a), margin_b(of_b) {}
  void setShapeIdentifiersA(int, int) override {}
  void setShapeIdentifiersB(int, int) override {}
  void addContactPoint(const btVector3& normal_on_b_W, const btVector3& on_b_W, btScalar depth) override {
    normal_W = normal_on_b_W;
    gap = depth + (margin_a + margin_b);
    result.addContactPoint(normal_on_b_W, on_b_W - normal_on_b_W * margin_b, gap);
  }
};

// A box's corners include its margin.
btScalar margin_of(const btConvexShape& shape) {
  return shape.getShapeType() == BOX_SHAPE_PROXYTYPE ? 0 : shape.getMargin();
}

class HullSolidAlgorithm : public btCollisionAlgorithm {
 public:
  HullSolidAlgorithm(const btCollisionAlgorithmConstructionInfo& info, HullSolidContacts::Shared& shared)
      : btCollisionAlgorithm(info), shared_(shared) {}
  ~HullSolidAlgorithm() override {
    if (manifold_) m_dispatcher->releaseManifold(manifold_);
  }

  void processCollision(const btCollisionObjectWrapper* body0, const btCollisionObjectWrapper* body1,
                        const btDispatcherInfo&, btManifoldResult* result) override {
    if (!manifold_) manifold_ = m_dispatcher->getNewManifold(body0->getCollisionObject(), body1->getCollisionObject());
    result->setPersistentManifold(manifold_);
    const auto& a = *static_cast<const btPolyhedralConvexShape*>(body0->getCollisionShape());
    const auto& b = *static_cast<const btPolyhedralConvexShape*>(body1->getCollisionShape());
    const btScalar reach = manifold_->getContactBreakingThreshold();

    // Nearest points, or deepest ones, by GJK and EPA.
    btVoronoiSimplexSolver simplex;
    btGjkPairDetector nearest(&a, &b, &simplex, &shared_.depth);
    btGjkPairDetector::ClosestPointInput input;
    input.m_transformA = body0->getWorldTransform();
    input.m_transformB = body1->getWorldTransform();
    const btScalar furthest = a.getMargin() + b.getMargin() + reach;
    input.m_maximumDistanceSquared = furthest * furthest;
    WithoutMargins found(*result, margin_of(a), margin_of(b));
    nearest.getClosestPoints(input, found, nullptr);

    // Overlapping: all corners of the contact's face.
    if (found.gap < 0)
      btPolyhedralContactClipping::clipHullAgainstHull(
          found.normal_W, *a.getConvexPolyhedron(), *b.getConvexPolyhedron(), body0->getWorldTransform(),
          body1->getWorldTransform(), found.gap - reach, reach, shared_.face_W, shared_.clipped_W, *result);
    result->refreshContactPoints();
  }

  btScalar calculateTimeOfImpact(btCollisionObject*, btCollisionObject*, const btDispatcherInfo&,
                                 btManifoldResult*) override {
    return 1;
  }
  void getAllContactManifolds(btManifoldArray& manifolds) override {
    if (manifold_) manifolds.push_back(manifold_);
  }

 private:
  HullSolidContacts::Shared& shared_;
  btPersistentManifold* manifold_ = nullptr;
};

}  // namespace

btCollisionAlgorithm* HullSolidContacts::Create::CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                                          const btCollisionObjectWrapper*,
                                                                          const btCollisionObjectWrapper*) {
  static_assert(sizeof(HullSolidAlgorithm) <= sizeof(btConvexConvexAlgorithm));  // room in Bullet's pool
  void* memory = info.m_dispatcher1->allocateCollisionAlgorithm(sizeof(HullSolidAlgorithm));
  return new (memory) HullSolidAlgorithm(info, shared);
}

HullSolidContacts::HullSolidContacts() {
  create_.shared.face_W.reserve(kManyCorners);
  create_.shared.clipped_W.reserve(kManyCorners);
}

}  // namespace kenaf::physics
