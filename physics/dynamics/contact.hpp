// One contact point in the solver of a step: a normal that gives way a little, friction within an ellipse, and the
// belts that run through it. docs/physics.md has the equations and why they are so.
#pragma once

#include <span>

#include "physics/dynamics/bullet.hpp"
#include "physics/dynamics/shear.hpp"
#include "physics/dynamics/solver_body.hpp"
#include "physics/dynamics/surface.hpp"

namespace kenaf::physics {

struct ContactSettings {
  double stiffness_npm;  // of one contact point
  double damping_nspm;
};

// The two bodies that touch. All velocities are those of body A relative to body B; A is never fixed.
struct Meeting {
  const Collider *collider_a, *collider_b;
  SolverBody *body_a, *body_b;  // null: B is fixed
  const Surface *surface_a, *surface_b;
  // The axes about which their belts turn, in W, and the share of the belts' speed that moves their surfaces; unused
  // without a belt.
  btVector3 belt_axis_a, belt_axis_b;
  btScalar driving_a, driving_b;
  btScalar warm_start_share;  // of the last step's friction impulse that this step starts from

  Meeting(const btCollisionObject& a, const btCollisionObject& b, SolverBody* solver_a, SolverBody* solver_b,
          const Surface& on_a, const Surface& on_b);
};

// One point where they touch, from whichever algorithm.
struct Touch {
  btVector3 p_W, normal_W;  // the normal points from B to A
  btScalar gap_m, weight;   // weight: factor of stiffness and damping
  bool holds_lugs;
  btScalar* stored_impulse[3];  // where it is kept from step to step: normal, along, across
  ShearStretch stretch = {};    // on which the belt shears the ground; none: all of the friction
};

class Contact {
 public:
  Contact(const Meeting& meeting, const Touch& touch, const ContactSettings& settings, btScalar time_step);

  void warm_start();
  // One iteration over contacts in their order. Returns the largest squared velocity change of a body A. `some_shear`:
  // a contact of them may have a stretch; without, none of its cost.
  static btScalar solve(std::span<Contact> contacts, bool some_shear);
  // Writes the impulses back to where they were taken from.
  void finish();

  const Collider& collider_a() const { return *collider_a_; }
  const Collider& collider_b() const { return *collider_b_; }
  // Of the robots that these belong to.
  TouchingPart part_a() const { return part_a_; }
  TouchingPart part_b() const { return part_b_; }
  const btVector3& p_W() const { return p_W_; }
  // Newton seconds of the step: normal and friction. B has the opposite.
  btVector3 impulse_on_a_W() const {
    return vector_of(row_[0], 0) * normal_impulse_ + vector_of(row_[1], 0) * friction_impulse_[0] +
           vector_of(row_[2], 0) * friction_impulse_[1];
  }
  bool pressed() const { return normal_impulse_ > 0; }

 private:
  // The state of A that a contact changes.
  struct Moved {
    TwoVectors& delta;
    btScalar &belt_mps, &load_ns;
  };
  Moved in_place(btScalar& none) const;  // `none` stands in for a belt's state where A has no belt
  bool on_ground() const { return !body_b_ && !belt_b_; }
  template <bool kSomeShear>
  static btScalar solve_each(std::span<Contact> contacts);
  template <bool kOnGround, bool kSomeShear>
  btScalar solve_one(Moved a);
  template <bool kOnGround>
  void apply(Moved a, btScalar normal, Two friction);
  // The friction impulses with all of the coefficient, and with the share that has built up.
  Two coulomb_friction(Two slip, btScalar normal) const;
  Two sheared_friction(Two slip, btScalar normal) const;

  SolverBody *body_a_, *body_b_;
  Belt *belt_a_, *belt_b_;
  // Three rows: normal, along, across; the linear part in lane 0, the angular part in lane 1.
  TwoVectors row_[3];       // Jacobian: row velocity for a unit velocity of A: axis, arm x axis
  TwoVectors response_[3];  // velocity change of A for a unit impulse
  // The same for B, but the linear part of response_b_ lacks B's inverse mass: apply() multiplies the sum of the three
  // rows by it. Another order of these products would change the last digits of every result.
  TwoVectors row_b_[3], response_b_[3];
  btScalar inverse_mass_a_;
  // Friction quantities: along in lane 0, across in lane 1.
  btScalar normal_impulse_;
  Two friction_impulse_;
  btScalar normal_velocity_;  // before any impulse of this step
  Two slip_;
  btScalar normal_mass_, softness_, give_velocity_;
  Two normal_to_slip_;  // slip change for a unit normal impulse
  Two stick_[2];        // inverse of the 2 x 2 matrix from friction impulse to slip
  Two slide_step_;      // 1 / (largest eigenvalue of the scaled matrix), times mu
  Two mu_, inverse_mu_;
  ShearStretch stretch_;
  Two belt_gain_a_, belt_gain_b_;  // slip for a unit belt speed; 0 without a belt
  Two belt_push_a_, belt_push_b_;  // belt speed for a unit friction impulse
  btScalar* stored_impulse_[3];
  const Collider *collider_a_, *collider_b_;
  btVector3 p_W_;
  TouchingPart part_a_, part_b_;
};

}  // namespace kenaf::physics
