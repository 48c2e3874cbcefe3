// A moving thing in the solver of a step: a rigid body and the arms that hinge on it. Hinges are not equations to
// iterate over: they are eliminated, so that an impulse at any point moves all of it at once, as in Featherstone, Rigid
// Body Dynamics Algorithms, 2008, chapter 7, for a tree of a base and its leaves.
//
// The unknowns are the base's velocity at the common centre of mass C, (v_C, w), and the rate of each arm j about its
// axis s_j. With M the mass, I_C the moment of inertia of all with the hinges stiff, and c_j (6), d_j of arm j alone,
//   [ diag(M, I_C)   c_j ] [ (v_C, w) ]   [ momentum of all about C    ]
//   [ c_j^T          d_j ] [ rate_j   ] = [ momentum of j about s_j + servo's impulse ]
// A servo within its torque holds its rate at the target: the arm is one with the base. One that yields (by its
// compliance, or at the end of its torque) has a mobility g_j > 0, and its rate follows:
//   rate_j = g_j (r_j - c_j . (v_C, w))
// Put into the rows of the base this takes g_j c_j c_j^T from their matrix, whose inverse is that of diag(M, I_C) and a
// sum of u u^T, by Sherman and Morrison.
//
// Frames: all in W. Lane 0 of a TwoVectors is linear, lane 1 angular. Thread safety: values; each body by one thread.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "physics/dynamics/bullet.hpp"
#include "physics/dynamics/flipper_joint.hpp"
#include "physics/dynamics/two_vectors.hpp"

namespace kenaf::physics {

struct Arm {
  FlipperJoint* joint;
  btRigidBody* body;
  btVector3 pivot_W, axis_W;   // a positive rate turns the arm about the axis
  btVector3 bias_v, bias_w;    // of the arm at its pivot relative to the base: what closes the hinge again
  TwoVectors coupling;         // c_j
  btScalar inertia, momentum;  // d_j, and that of the arm about its axis before the servo's impulse
  btScalar mobility = 0;       // g_j, (rad/s) / (N m s); 0: the servo holds
  btScalar rate = 0;           // without contacts
  btScalar push_nms = 0;       // by contacts, about the axis
};

struct ArticulatedBody {
  TwoVectors delta{};  // velocity change at C by the contacts of this step
  btVector3 v, w;      // at C at the end of the step, without contacts
  btVector3 p_WC;
  TwoVectors momentum;  // about C, at the end of a step without contacts and servos
  btScalar inverse_mass;
  btMatrix3x3 inverse_inertia_W;  // about C, hinges stiff
  std::span<Arm> arms;
  std::array<TwoVectors, robot::kFlipperCount> loose;  // u of each arm whose servo yields
  std::size_t loose_count = 0;
  btRigidBody* base;
  int contact_count = 0;  // that may press in this step

  // The velocity change at C by an impulse with these components: linear, and moment about C.
  TwoVectors response(const TwoVectors& impulse) const {
    const btVector3 linear = vector_of(impulse, 0) * inverse_mass, angular = inverse_inertia_W * vector_of(impulse, 1);
    TwoVectors change = side_by_side(linear, angular);
    for (std::size_t i = 0; i < loose_count; ++i) change += loose[i] * sum_of_lanes(dot(loose[i], impulse));
    return change;
  }
};

// The body of `base`, and of those that `arms` name with their joints and nothing else filled in, at the end of a step
// without contacts. Each servo acts as its joint says that it did at the end of the last step.
ArticulatedBody to_solver(btRigidBody& base, std::span<Arm> arms, btScalar time_step, btScalar correction_per_s);

// Whether a servo acts otherwise than was assumed: one that holds would need more than its torque, or one that is at
// the end of its torque is faster than its target. Then joints say what they do now; begin_anew() has to follow.
bool settle_servos(ArticulatedBody& body);
// Without contacts, with the servos as the joints say.
void begin_anew(ArticulatedBody& body);

// Velocities to Bullet, servos' impulses to the joints.
void write_back(const ArticulatedBody& solved);

}  // namespace kenaf::physics
