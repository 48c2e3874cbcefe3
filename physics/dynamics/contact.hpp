// One contact point in the solver of a step: a normal that gives way a little, friction within an ellipse, and the
// belts that run through it. docs/physics.md has the equations and why they are so.
#pragma once

#include <span>
#include <vector>

#include "physics/dynamics/articulated_body.hpp"
#include "physics/dynamics/bullet.hpp"
#include "physics/dynamics/friction_creep.hpp"
#include "physics/dynamics/shear.hpp"
#include "physics/dynamics/surface.hpp"

namespace kenaf::physics {

struct ContactSettings {
  double stiffness_npm;  // of one contact point
  double damping_nspm;
};

// What a contact moves. arm: on which it is, of that body; null: on the base.
struct ContactSide {
  ArticulatedBody* body = nullptr;  // null: it is fixed
  Arm* arm = nullptr;
};

// The two bodies that touch. All velocities are those of body A relative to body B; A is never fixed.
struct Meeting {
  const Collider *collider_a, *collider_b;
  ContactSide side_a, side_b;
  const Surface *surface_a, *surface_b;
  // The axes about which their belts turn, in W, and the share of the belts' speed that moves their surfaces; unused
  // without a belt.
  btVector3 belt_axis_a, belt_axis_b;
  btScalar driving_a, driving_b;
  btScalar warm_start_share;  // of its friction impulse that a contact which sticks leaves to the next step

  Meeting(const btCollisionObject& a, const btCollisionObject& b, const ContactSide& moves_a,
          const ContactSide& moves_b, const Surface& on_a, const Surface& on_b);
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
  // Counts it for its bodies (ArticulatedBody::contact_count), if it presses or would without the others.
  void count() const;
  struct Change {  // of the impulses, with the slip that called for it
    btScalar normal;
    Two friction, slip;
  };
  struct State {  // of A, or a change of it, by contacts
    TwoVectors delta{};
    btScalar arm_nms = 0, belt_ns = 0, load_ns = 0;
  };
  // Of contacts that all saw the same velocities.
  struct SharedChanges {
    struct OfRun {  // of contacts that move the same things, on fixed ground
      const Contact* any;
      State sum;
    };
    struct BetweenMoving {
      Contact* contact;
      Change change;
    };
    std::vector<OfRun> runs;
    std::vector<BetweenMoving> between_moving;
  };
  // An iteration in which each contact moves an equal share of its body's mass, all by the same velocities (mass
  // splitting: Tonge, Benevolenski, Voroshilov, "Mass splitting for jitter-free parallel rigid body simulation", 2012).
  // What several could hold is shared evenly, whatever their order. Returns the largest squared velocity change of a
  // body A that a contact would make alone.
  static btScalar share(std::span<Contact> contacts, bool some_shear, SharedChanges& changes);
  // One iteration over contacts in their order, each with what those before it have left. Returns the largest squared
  // velocity change of a body A. `some_shear`: a contact of them may have a stretch; without, none of its cost.
  static btScalar solve(std::span<Contact> contacts, bool some_shear);
  // Writes the impulses to where they were taken from, to make the contact anew in this step.
  void keep_impulses() const;
  // After the last iteration. Where the contact slides, its slip gives its friction; where it sticks, its friction
  // fades.
  bool sticks() const;
  void fade();
  // Whether its friction moves A's base and nothing else: a belt or an arm that yields would take a part.
  bool moves_base_alone() const;
  // Of such a contact: what it loses, to be called before it fades; its part in giving back; and what it gets.
  void lose_to(FrictionCreep& creep) const;
  void add_spring_to(FrictionCreep& creep) const;
  void take_back(const TwoVectors& given_back);

  const ArticulatedBody* body_a() const { return a_.body; }
  const Collider& collider_a() const { return *collider_a_; }
  const Collider& collider_b() const { return *collider_b_; }
  // Of the robots that these belong to.
  TouchingPart part_a() const { return part_a_; }
  TouchingPart part_b() const { return part_b_; }
  const btVector3& p_W() const { return p_W_; }
  // Newton seconds of the step: normal and friction. B has the opposite.
  btVector3 impulse_on_a_W() const {
    return normal_W_ * normal_impulse_ + vector_of(tangents_W_, 0) * friction_impulse_[0] +
           vector_of(tangents_W_, 1) * friction_impulse_[1];
  }
  bool pressed() const { return normal_impulse_ > 0; }

 private:
  // The state of A that a contact changes.
  struct Moved {
    TwoVectors& delta;
    btScalar &arm_nms, &belt_ns, &load_ns;
    btScalar arm_mobility, belt_mobility;

    State state() const { return {delta, arm_nms, belt_ns, load_ns}; }
  };
  // One body's part in the three rows normal, along, across.
  struct Rows {
    TwoVectors row[3];  // row velocity for a unit velocity at C of the body, with what its arm's rate follows of it
    TwoVectors response[3];  // velocity change at C for a unit impulse
    btScalar lever = 0;      // of the normal about the arm's axis, m
    Two levers{0, 0};        // of the tangents
  };
  struct Mobility;
  static Mobility set_rows(Rows& rows, const ContactSide& side, const btVector3& p_W, const btVector3& normal,
                           const TwoVectors& tangents);
  static Mobility mobility_of(const Rows& of, const Arm* arm);
  Mobility merge_rows();
  Moved in_place(State& none) const;  // `none` stands in for what A has not
  static Moved moved(State& state, const Moved& like) {
    return {state.delta, state.arm_nms, state.belt_ns, state.load_ns, like.arm_mobility, like.belt_mobility};
  }
  static std::span<Contact> run_at_front(std::span<Contact> contacts);
  bool on_ground() const { return !b_.body && !belt_b_; }
  template <bool kSomeShear>
  static btScalar solve_each(std::span<Contact> contacts);
  template <bool kSomeShear>
  static btScalar share_each(std::span<Contact> contacts, SharedChanges& changes);
  // What the contact would do if nothing else changed and it alone moved `share` of the bodies' masses.
  template <bool kOnGround, bool kSomeShear>
  Change wanted_change(const Moved& a, btScalar share) const;
  template <bool kOnGround>
  void make(const Change& change, const Moved& a);
  btScalar residual_of(const Change& change) const;
  template <bool kOnGround>
  void apply(Moved a, btScalar normal, Two friction);
  // The friction impulses with all of the coefficient, and with the share that has built up.
  Two coulomb_friction(Two slip, btScalar normal) const;
  Two sheared_friction(Two slip, btScalar normal, btScalar share) const;

  ContactSide a_, b_;
  Belt *belt_a_, *belt_b_;
  Rows rows_a_, rows_b_;  // B's: unused if it is fixed
  btScalar inverse_mass_a_;
  // Friction quantities: along in lane 0, across in lane 1.
  btScalar normal_impulse_;
  Two friction_impulse_;
  Two last_slip_{0, 0};       // before the last change
  btScalar fading_;           // the share of a friction that sticks which is left for the next step
  btScalar normal_velocity_;  // before any impulse of this step
  Two slip_;
  btScalar normal_mobility_, normal_mass_, softness_, give_velocity_;
  Two normal_to_slip_;  // slip change for a unit normal impulse
  Two stick_[2];        // inverse of the 2 x 2 matrix from friction impulse to slip
  Two slide_step_;      // 1 / (largest eigenvalue of the scaled matrix), times mu
  Two mu_, inverse_mu_;
  ShearStretch stretch_;
  Two gain_a_, gain_b_;  // slip for a unit belt speed, and push on the belt for a unit impulse; 0 without a belt
  btScalar* stored_impulse_[3];
  const Collider *collider_a_, *collider_b_;
  btVector3 p_W_, normal_W_;
  TwoVectors tangents_W_;
  TouchingPart part_a_, part_b_;
};

}  // namespace kenaf::physics
