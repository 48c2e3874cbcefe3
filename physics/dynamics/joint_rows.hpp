// The six rows of a flipper's joint in the solver of a step: five that hold it together, and its servo's.
//
// Each row waits for the one before, so what counts is how long one takes from velocity to velocity. Both bodies'
// numbers are side by side, in registers for all six rows, and there are no sums of zeros; with the same in Contact
// that takes 12 % off a climb's time.
#pragma once

#include <array>

#include "physics/dynamics/bullet.hpp"
#include "physics/dynamics/flipper_joint.hpp"
#include "physics/dynamics/solver_body.hpp"

namespace kenaf::physics {

class JointRows {
 public:
  // Begins with the impulses of the last step.
  JointRows(FlipperJoint& joint, SolverBody& a, SolverBody& b, const btContactSolverInfo& info);
  void warm_start();
  // One iteration; gives the largest square of a change of velocity.
  btScalar solve();
  // Leaves the impulses with the joint.
  void finish();

 private:
  // A row works on both bodies in the same way: lane 0 is of A, lane 1 of B.
  struct Velocities {
    TwoVectors linear, angular;
  };
  struct Row {
    TwoVectors angular, turn;   // its velocity for a unit angular velocity, angular velocity for a unit impulse
    btScalar velocity_impulse;  // that brings it to its velocity
    btScalar softness;          // times mass
    btScalar mass, inverse_mass;
    btScalar low, high;
    btScalar impulse;

    btScalar change(Two velocity);  // gives the impulse for that velocity
  };
  Velocities begin() const;
  void end(const Velocities& v);

  std::array<Row, FlipperJoint::kRows> rows_;
  Two push_;  // velocity for a unit impulse of the first three rows, along their axes
  FlipperJoint* joint_;
  SolverBody *a_, *b_;
};

}  // namespace kenaf::physics
