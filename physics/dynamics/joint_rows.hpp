// The six rows of a flipper's joint in the solver of a step: five that hold it together, and its servo's.
//
// Each row depends on the one before, so the latency of a row counts. Both bodies' numbers are side by side, in
// registers for all six rows, and sums of zeros are left out; together with the same in Contact this saves 12 % of a
// climb's time.
#pragma once

#include <array>

#include "physics/dynamics/bullet.hpp"
#include "physics/dynamics/flipper_joint.hpp"
#include "physics/dynamics/solver_body.hpp"

namespace kenaf::physics {

class JointRows {
 public:
  // Starts from the impulses of the last step.
  JointRows(FlipperJoint& joint, SolverBody& a, SolverBody& b, const btContactSolverInfo& info);
  void warm_start();
  // One iteration. Returns the largest squared velocity change.
  btScalar solve();
  // Stores the impulses in the joint.
  void finish();

 private:
  // A row works on both bodies in the same way: lane 0 is of A, lane 1 of B.
  struct Velocities {
    TwoVectors linear, angular;
  };
  struct Row {
    TwoVectors angular, turn;   // Jacobian; angular velocity for a unit impulse
    btScalar velocity_impulse;  // brings the row to its velocity
    btScalar softness;          // times mass
    btScalar mass, inverse_mass;
    btScalar low, high;
    btScalar impulse;

    btScalar change(Two velocity);  // returns the change of impulse at that velocity
  };
  Velocities begin() const;
  void end(const Velocities& v);

  std::array<Row, FlipperJoint::kRows> rows_;
  Two push_;  // velocity for a unit impulse of the first three rows, along their axes
  FlipperJoint* joint_;
  SolverBody *a_, *b_;
};

}  // namespace kenaf::physics
