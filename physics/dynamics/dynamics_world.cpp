#include "physics/dynamics/dynamics_world.hpp"

#include <LinearMath/btTransformUtil.h>

namespace kenaf::physics {
namespace {

// btRigidBody::predictIntegratedTransform, compiled here so that it is inlined: saves 1 % of a climb's time.
btTransform pose_after(const btRigidBody& body, btScalar time_step) {
  btTransform X;
  btTransformUtil::integrateTransform(body.getWorldTransform(), body.getLinearVelocity(), body.getAngularVelocity(),
                                      time_step, X);
  return X;
}

bool contains(const btBroadphaseProxy& box, const btVector3& low_W, const btVector3& high_W) {
  for (int k = 0; k < 3; ++k)
    if (!(box.m_aabbMin[k] <= low_W[k] && high_W[k] <= box.m_aabbMax[k])) return false;
  return true;
}

}  // namespace

// A body's box in the broad phase is larger than the body by kSpare_m, and stays until the body leaves it.
void DynamicsWorld::updateAabbs() {
  constexpr btScalar kSpare_m = 0.005;           // at 0.2 m/s a new box each 25 steps of 1 ms
  constexpr btScalar kLargestSquared_m2 = 1e12;  // as in btCollisionWorld::updateSingleAabb
  const btVector3 touching(gContactBreakingThreshold, gContactBreakingThreshold, gContactBreakingThreshold);
  const btVector3 spare(kSpare_m, kSpare_m, kSpare_m);
  for (int i = 0; i < m_nonStaticRigidBodies.size(); ++i) {
    btRigidBody& body = *m_nonStaticRigidBodies[i];
    if (!body.isActive()) continue;
    btBroadphaseProxy& box = *body.getBroadphaseProxy();
    btVector3 low_W, high_W;
    body.getCollisionShape()->getAabb(body.getWorldTransform(), low_W, high_W);
    low_W -= touching;
    high_W += touching;
    if (contains(box, low_W, high_W)) continue;
    if ((high_W - low_W).length2() < kLargestSquared_m2)
      m_broadphasePairCache->setAabb(&box, low_W - spare, high_W + spare, m_dispatcher1);
    else
      updateSingleAabb(&body);  // deactivates it
  }
}

void DynamicsWorld::solveConstraints(btContactSolverInfo& info) {
  solver_.solve(m_nonStaticRigidBodies, *getDispatcher(), m_constraints, info);
}

void DynamicsWorld::integrateTransforms(btScalar time_step) {
  for (int i = 0; i < m_nonStaticRigidBodies.size(); ++i) {
    btRigidBody& body = *m_nonStaticRigidBodies[i];
    if (!body.isActive()) continue;  // Bullet deactivates a body whose box is too large for its broad phase
    body.proceedToTransform(pose_after(body, time_step));
  }
}

}  // namespace kenaf::physics
