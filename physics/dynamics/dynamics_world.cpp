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

}  // namespace

// As btCollisionWorld::updateSingleAabb does it, but without where a body will be. A fixed body keeps its box, and has
// to say so: the broad phase takes what is silent for two steps to another tree, which allocates.
void DynamicsWorld::updateAabbs() {
  constexpr btScalar kLargestSquared_m2 = 1e12;
  const btVector3 touching(gContactBreakingThreshold, gContactBreakingThreshold, gContactBreakingThreshold);
  for (int i = 0; i < m_collisionObjects.size(); ++i) {
    btCollisionObject& object = *m_collisionObjects[i];
    btBroadphaseProxy& box = *object.getBroadphaseHandle();
    if (object.isStaticObject()) {
      m_broadphasePairCache->setAabb(&box, box.m_aabbMin, box.m_aabbMax, m_dispatcher1);
      continue;
    }
    if (!object.isActive()) continue;
    btVector3 low_W, high_W;
    object.getCollisionShape()->getAabb(object.getWorldTransform(), low_W, high_W);
    if ((high_W - low_W).length2() < kLargestSquared_m2)
      m_broadphasePairCache->setAabb(&box, low_W - touching, high_W + touching, m_dispatcher1);
    else
      updateSingleAabb(&object);  // deactivates it
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
