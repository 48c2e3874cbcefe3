// Bullet's world with our own step: Bullet finds contacts, the contact solver does the rest.
//
// Parts of Bullet's step without effect here are left out: damping of 0, predicted poses and contacts of
// fast bodies (none use them), sleeping, and islands, as the solver finds its own groups.
#pragma once

#include "physics/dynamics/bullet.hpp"
#include "physics/dynamics/contact_solver.hpp"

namespace kenaf::physics {

class DynamicsWorld : public btDiscreteDynamicsWorld {
 public:
  // All bodies must be dynamic or static, and each constraint a FlipperJoint.
  DynamicsWorld(btDispatcher& dispatcher, btBroadphaseInterface& broadphase, btCollisionConfiguration& configuration,
                ContactSolver& solver)
      : btDiscreteDynamicsWorld(&dispatcher, &broadphase, nullptr, &configuration), solver_(solver) {}

  void solveConstraints(btContactSolverInfo& info) override;

 protected:
  void updateAabbs() override;
  void predictUnconstraintMotion(btScalar) override {}
  void createPredictiveContacts(btScalar) override {}
  void calculateSimulationIslands() override {}
  void integrateTransforms(btScalar time_step) override;
  void updateActivationState(btScalar) override {}

 private:
  ContactSolver& solver_;
};

}  // namespace kenaf::physics
