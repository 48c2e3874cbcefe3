#include "physics/dynamics_world.hpp"

#include <LinearMath/btTransformUtil.h>

namespace kenaf::physics {
namespace {

// btRigidBody::predictIntegratedTransform, compiled here in one piece: 1 % of a climb.
btTransform pose_after(const btRigidBody& body, btScalar time_step) {
  btTransform X;
  btTransformUtil::integrateTransform(body.getWorldTransform(), body.getLinearVelocity(), body.getAngularVelocity(),
                                      time_step, X);
  return X;
}

}  // namespace

// Where the bodies would go: the boxes of the broad phase hold this place too.
void DynamicsWorld::predictUnconstraintMotion(btScalar time_step) {
  for (int i = 0; i < m_nonStaticRigidBodies.size(); ++i) {
    btRigidBody& body = *m_nonStaticRigidBodies[i];
    body.setInterpolationWorldTransform(pose_after(body, time_step));
  }
}

void DynamicsWorld::calculateSimulationIslands() {
  // the joints' order follows from them; those of one robot are on one island
  const auto same_robot = [this](int i) {
    return &m_constraints[i]->getRigidBodyA() == &m_constraints[0]->getRigidBodyA();
  };
  for (int i = 1; i < m_constraints.size(); ++i)
    if (!same_robot(i)) return btDiscreteDynamicsWorld::calculateSimulationIslands();
}

void DynamicsWorld::solveConstraints(btContactSolverInfo& info) {
  m_sortedConstraints.resize(m_constraints.size());
  for (int i = 0; i < m_constraints.size(); ++i) m_sortedConstraints[i] = m_constraints[i];
  m_sortedConstraints.quickSort([](const btTypedConstraint* a, const btTypedConstraint* b) {
    return a->getRigidBodyA().getIslandTag() < b->getRigidBodyA().getIslandTag();
  });
  solver_.solve(m_nonStaticRigidBodies, *getDispatcher(), m_sortedConstraints, info);
}

void DynamicsWorld::integrateTransforms(btScalar time_step) {
  for (int i = 0; i < m_nonStaticRigidBodies.size(); ++i) {
    btRigidBody& body = *m_nonStaticRigidBodies[i];
    if (!body.isActive()) continue;  // Bullet stops what has become too large for its broad phase
    body.proceedToTransform(pose_after(body, time_step));
  }
}

}  // namespace kenaf::physics
