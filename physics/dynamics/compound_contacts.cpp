#include "physics/dynamics/compound_contacts.hpp"

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/CollisionDispatch/btCompoundCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btManifoldResult.h>
#include <LinearMath/btAabbUtil2.h>

#include <array>
#include <memory>
#include <new>
#include <span>

namespace kenaf::physics {
namespace {

constexpr int kWholeBody = -1;  // index of the only piece of a body that is no compound

const btCompoundShape* compound_of(const btCollisionObjectWrapper& body) {
  const btCollisionShape& shape = *body.getCollisionShape();
  return shape.isCompound() ? &static_cast<const btCompoundShape&>(shape) : nullptr;
}

std::size_t piece_count(const btCollisionObjectWrapper& body) {
  const btCompoundShape* compound = compound_of(body);
  return compound ? static_cast<std::size_t>(compound->getNumChildShapes()) : 1;
}

// One shape of a body, with its pose.
struct Piece {
  int index;
  btTransform X_W;
  btCollisionObjectWrapper wrapper;
  btVector3 low_W{0, 0, 0}, high_W{0, 0, 0};  // the analyzer does not see that getAabb() sets both

  Piece(const btCollisionObjectWrapper& body, std::size_t number)
      : index(compound_of(body) ? static_cast<int>(number) : kWholeBody),
        X_W(index == kWholeBody ? body.getWorldTransform()
                                : body.getWorldTransform() * compound_of(body)->getChildTransform(index)),
        wrapper(&body, index == kWholeBody ? body.getCollisionShape() : compound_of(body)->getChildShape(index),
                body.getCollisionObject(), X_W, -1, index) {
    wrapper.getCollisionShape()->getAabb(X_W, low_W, high_W);
  }
};

// Whether the bounding boxes also overlap in the compound's frame, where those of a tilted robot are tighter.
bool near_in(const btTransform& X_CW, const Piece& a, const Piece& b) {
  btVector3 low_a, high_a, low_b, high_b;
  a.wrapper.getCollisionShape()->getAabb(X_CW * a.X_W, low_a, high_a);
  b.wrapper.getCollisionShape()->getAabb(X_CW * b.X_W, low_b, high_b);
  return TestAabbAgainstAabb2(low_a, high_a, low_b, high_b);
}

class CompoundAlgorithm : public btCollisionAlgorithm {
 public:
  // `swapped`: the second body is the compound. The counts are of the compound's pieces and of the other body's.
  CompoundAlgorithm(const btCollisionAlgorithmConstructionInfo& info, bool swapped, std::size_t count,
                    std::size_t other_count)
      : btCollisionAlgorithm(info), other_count_(other_count), swapped_(swapped) {
    if (count * other_count > few_.size()) many_ = std::make_unique<btCollisionAlgorithm*[]>(count * other_count);
    pairs_ = {many_ ? many_.get() : few_.data(), count * other_count};
  }
  ~CompoundAlgorithm() override {
    for (btCollisionAlgorithm*& pair : pairs_) end(pair);
  }

  void processCollision(const btCollisionObjectWrapper* body0, const btCollisionObjectWrapper* body1,
                        const btDispatcherInfo& dispatch, btManifoldResult* result) override {
    const btCollisionObjectWrapper& compound = swapped_ ? *body1 : *body0;
    const btCollisionObjectWrapper& other = swapped_ ? *body0 : *body1;

    // Each pair of pieces has an algorithm of its own from when their boxes overlap in both frames until they no longer
    // do in W.
    const btTransform X_CW = compound.getWorldTransform().inverse();
    const std::size_t count = pairs_.size() / other_count_;
    for (std::size_t j = 0; j < other_count_; ++j) {
      const Piece b(other, j);
      for (std::size_t i = 0; i < count; ++i) {
        const Piece a(compound, i);
        btCollisionAlgorithm*& pair = pairs_[i * other_count_ + j];
        if (!TestAabbAgainstAabb2(a.low_W, a.high_W, b.low_W, b.high_W))
          end(pair);
        else if (pair || near_in(X_CW, a, b))
          meet(a, b, pair, dispatch, *result);
      }
    }
  }

  btScalar calculateTimeOfImpact(btCollisionObject*, btCollisionObject*, const btDispatcherInfo&,
                                 btManifoldResult*) override {
    return 1;
  }
  void getAllContactManifolds(btManifoldArray& manifolds) override {
    for (btCollisionAlgorithm* pair : pairs_)
      if (pair) pair->getAllContactManifolds(manifolds);
  }

 private:
  void meet(const Piece& a, const Piece& b, btCollisionAlgorithm*& pair, const btDispatcherInfo& dispatch,
            btManifoldResult& result) {
    // For the pair's algorithm the result speaks of the two pieces; afterwards of the whole bodies again.
    const btCollisionObjectWrapper *whole0 = result.getBody0Wrap(), *whole1 = result.getBody1Wrap();
    const Piece &piece0 = swapped_ ? b : a, &piece1 = swapped_ ? a : b;
    result.setBody0Wrap(&piece0.wrapper);
    result.setBody1Wrap(&piece1.wrapper);
    result.setShapeIdentifiersA(-1, piece0.index);
    result.setShapeIdentifiersB(-1, piece1.index);
    if (pair)
      refresh(*pair, result);
    else
      pair = m_dispatcher->findAlgorithm(&a.wrapper, &b.wrapper, nullptr, BT_CONTACT_POINT_ALGORITHMS);
    pair->processCollision(&a.wrapper, &b.wrapper, dispatch, &result);
    result.setBody0Wrap(whole0);
    result.setBody1Wrap(whole1);
  }

  // Moves the last step's points with the bodies, so that new ones are compared with their present places.
  static void refresh(btCollisionAlgorithm& pair, btManifoldResult& result) {
    std::array<btPersistentManifold*, 4> memory;  // none of ours has more than one
    btManifoldArray manifolds;
    manifolds.initializeFromBuffer(memory.data(), 0, static_cast<int>(memory.size()));
    pair.getAllContactManifolds(manifolds);
    for (int m = 0; m < manifolds.size(); ++m) {
      result.setPersistentManifold(manifolds[m]);
      result.refreshContactPoints();
    }
    result.setPersistentManifold(nullptr);
  }

  void end(btCollisionAlgorithm*& pair) {
    if (!pair) return;
    pair->~btCollisionAlgorithm();
    m_dispatcher->freeCollisionAlgorithm(pair);
    pair = nullptr;
  }

  // One for each piece with each of the other body's; null where they are apart. Robots on tracks need no memory of
  // their own.
  std::array<btCollisionAlgorithm*, CompoundContacts::kFewPieces * CompoundContacts::kFewPieces> few_{};
  std::unique_ptr<btCollisionAlgorithm*[]> many_;
  std::span<btCollisionAlgorithm*> pairs_;
  std::size_t other_count_;
  bool swapped_;
};

}  // namespace

btCollisionAlgorithm* CompoundContacts::Create::CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                                         const btCollisionObjectWrapper* body0,
                                                                         const btCollisionObjectWrapper* body1) {
  static_assert(sizeof(CompoundAlgorithm) <= sizeof(btCompoundCollisionAlgorithm));  // room in Bullet's pool
  const std::size_t count0 = piece_count(*body0), count1 = piece_count(*body1);
  void* memory = info.m_dispatcher1->allocateCollisionAlgorithm(sizeof(CompoundAlgorithm));
  return m_swapped ? new (memory) CompoundAlgorithm(info, true, count1, count0)
                   : new (memory) CompoundAlgorithm(info, false, count0, count1);
}

CompoundContacts::CompoundContacts(btCollisionDispatcher& dispatcher) {
  create_swapped_.m_swapped = true;
  const int compound = COMPOUND_SHAPE_PROXYTYPE;
  for (const int other :
       {STATIC_PLANE_PROXYTYPE, BOX_SHAPE_PROXYTYPE, CONVEX_HULL_SHAPE_PROXYTYPE, TRIANGLE_MESH_SHAPE_PROXYTYPE}) {
    dispatcher.registerCollisionCreateFunc(compound, other, &create_);
    dispatcher.registerCollisionCreateFunc(other, compound, &create_swapped_);
  }
  dispatcher.registerCollisionCreateFunc(compound, compound, &create_);
}

}  // namespace kenaf::physics
