// Bullet's world with a step of our own: Bullet finds what touches, the contact solver does the rest.
//
// Left out of Bullet's step is what has no effect here, 4 % of a climb's time: damping of 0, contacts predicted for
// fast bodies (none ask for them), sleeping, and islands: the solver finds its groups by what touches.
#pragma once

#include "physics/dynamics/bullet.hpp"
#include "physics/dynamics/contact_solver.hpp"

namespace kenaf::physics {

class DynamicsWorld : public btDiscreteDynamicsWorld {
 public:
  // All that is added to it moves freely, or not at all; each constraint is a FlipperJoint.
  DynamicsWorld(btDispatcher& dispatcher, btBroadphaseInterface& broadphase, btCollisionConfiguration& configuration,
                ContactSolver& solver)
      : btDiscreteDynamicsWorld(&dispatcher, &broadphase, nullptr, &configuration), solver_(solver) {}

  void solveConstraints(btContactSolverInfo& info) override;

 protected:
  void predictUnconstraintMotion(btScalar time_step) override;
  void createPredictiveContacts(btScalar) override {}
  void calculateSimulationIslands() override {}
  void integrateTransforms(btScalar time_step) override;
  void updateActivationState(btScalar) override {}

 private:
  ContactSolver& solver_;
};

}  // namespace kenaf::physics
