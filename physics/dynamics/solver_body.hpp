// A rigid body in the solver of a step: only what impulses need, close together in memory.
#pragma once

#include "physics/dynamics/bullet.hpp"
#include "physics/dynamics/two_vectors.hpp"

namespace kenaf::physics {

struct SolverBody {
  TwoVectors delta{};  // velocity change by the impulses of this step; lane 0: m/s, lane 1: rad/s
  btVector3 v, w;      // at the end of the step, without these impulses
  btVector3 p_W;
  btMatrix3x3 inverse_inertia_W;
  btScalar inverse_mass;
  btVector3 outer_v, outer_w;  // the part of v and w that gravity and the gyroscopic moment add in this step
  btRigidBody* body;
};

// The arithmetic is Bullet's, in its order (btSequentialImpulseConstraintSolver: initSolverBody, convertBodies,
// writeBackBodies), so it gives Bullet's bits.
SolverBody to_solver(btRigidBody& body, btScalar time_step);
void write_back(const SolverBody& solved);

}  // namespace kenaf::physics
