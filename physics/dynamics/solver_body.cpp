#include "physics/dynamics/solver_body.hpp"

namespace kenaf::physics {

SolverBody to_solver(btRigidBody& body, btScalar time_step) {
  SolverBody s;
  s.inverse_mass = body.getInvMass();
  s.inverse_inertia_W = body.getInvInertiaTensorWorld();
  s.p_W = body.getWorldTransform().getOrigin();
  s.outer_v = body.getTotalForce() * s.inverse_mass * time_step;
  s.outer_w = body.getTotalTorque() * s.inverse_inertia_W * time_step;
  s.outer_w += body.computeGyroscopicImpulseImplicit_Body(time_step);
  s.v = body.getLinearVelocity() + s.outer_v;
  s.w = body.getAngularVelocity() + s.outer_w;
  s.body = &body;
  return s;
}

void write_back(const SolverBody& solved) {
  btRigidBody& body = *solved.body;
  body.setLinearVelocity(body.getLinearVelocity() + vector_of(solved.delta, 0) + solved.outer_v);
  body.setAngularVelocity(body.getAngularVelocity() + vector_of(solved.delta, 1) + solved.outer_w);
}

}  // namespace kenaf::physics
