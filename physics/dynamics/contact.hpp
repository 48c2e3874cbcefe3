// One contact point in the solver of a step: a normal that gives way a little, friction within an ellipse, and the
// belts that run through it. docs/physics.md has the equations and why they are so.
#pragma once

#include <algorithm>

#include "physics/dynamics/bullet.hpp"
#include "physics/dynamics/contact_patch.hpp"
#include "physics/dynamics/shear.hpp"

namespace kenaf::physics {

struct ContactSettings {
  double stiffness_npm;  // of one contact point
  double damping_nspm;
};

// One point where two bodies touch, from whichever algorithm.
struct Touch {
  btVector3 p_W, normal_W;  // the normal points from B to A
  btScalar gap_m, weight;   // weight: factor of stiffness and damping
  bool holds_lugs;
  btScalar* stored_impulse[3];  // where it is kept from step to step: normal, along, across
  ShearStretch stretch = {};    // on which the belt shears the ground; none: all of the friction
};

class Contact {
 public:
  // Starts from the stored impulses.
  Contact(const ContactPatch& patch, const Touch& touch, const ContactSettings& settings, btScalar time_step);

  // Reads again what depends on the bodies of its patch.
  void take_bodies(const ContactPatch& patch);

  // The changes of velocity, by contacts of this step, that the contact sees: of A, less those of B.
  struct Seen {
    btScalar normal;
    Two slip;
  };
  struct Change {  // of the impulses, with the slip that called for it
    btScalar normal;
    Two friction, slip;
  };
  // What the contact would do if nothing else changed and it alone moved `share` of the bodies' masses. `kSomeShear`:
  // it may have a stretch; without, none of its cost.
  template <bool kSomeShear>
  Change wanted_change(const Seen& seen, btScalar share) const;
  void make(const Change& change) {
    normal_impulse_ += change.normal;
    friction_impulse_ += change.friction;
    last_slip_ = change.slip;
  }

  // Whether it presses, or would without the others.
  bool may_press() const { return normal_impulse_ > 0 || normal_velocity_ < give_velocity_; }
  bool pressed() const { return normal_impulse_ > 0; }
  bool sticks() const {
    constexpr btScalar kSlides_mps = 1e-4;  // as kStanding_mps of shear.cpp
    return pressed() && last_slip_[0] * last_slip_[0] + last_slip_[1] * last_slip_[1] <= kSlides_mps * kSlides_mps;
  }
  // After the last iteration. Where the contact slides, its slip gives its friction; where it sticks, its friction
  // fades, or is changed otherwise.
  void set_friction(Two impulse) { friction_impulse_ = impulse; }
  // Writes the impulses to where they were taken from.
  void keep_impulses() const;

  const btVector3& p_W() const { return p_W_; }
  const PlaceInPatch& from_a() const { return from_a_; }
  const PlaceInPatch& from_b() const { return from_b_; }
  // On A; B has the opposite. Newton seconds of the step.
  btScalar normal_impulse() const { return normal_impulse_; }
  Two friction_impulse() const { return friction_impulse_; }

 private:
  // The friction impulses with all of the coefficient, and with the share that has built up.
  Two coulomb_friction(Two slip, btScalar normal) const;
  Two sheared_friction(Two slip, btScalar normal, btScalar share) const;

  PlaceInPatch from_a_, from_b_;
  btScalar normal_impulse_;
  Two friction_impulse_;      // as all of friction, along in lane 0 and across in lane 1
  Two last_slip_{0, 0};       // before the last change
  btScalar normal_velocity_;  // before any impulse of this step
  Two slip_;
  btScalar normal_mobility_, normal_mass_, softness_, give_velocity_;
  Two normal_to_slip_;  // slip change for a unit normal impulse
  Two stick_[2];        // inverse of the 2 x 2 matrix from friction impulse to slip
  Two slide_step_;      // 1 / (largest eigenvalue of the scaled matrix), times mu
  Two mu_, inverse_mu_;
  ShearStretch stretch_;
  btScalar* stored_impulse_[3];
  btVector3 p_W_;
};

[[gnu::always_inline]] inline Two Contact::coulomb_friction(Two slip, btScalar normal) const {
  // Sticking: the impulse that stops the slip, if it lies within the limit ellipse.
  const Two friction = friction_impulse_ - stick_[0] * slip[0] - stick_[1] * slip[1];
  const Two scaled = friction * inverse_mu_;
  if (scaled[0] * scaled[0] + scaled[1] * scaled[1] <= normal * normal) return friction;
  // Sliding: projected gradient step, q - mu slip / eigenvalue, then back onto the circle of radius p_normal. Its fixed
  // point is the impulse of maximum dissipation: there the ellipse's normal points against the slip.
  const Two q = friction_impulse_ * inverse_mu_ - slide_step_ * slip;
  const btScalar length = btSqrt(q[0] * q[0] + q[1] * q[1]);
  const btScalar scale = length > normal ? normal / length : 1;
  return q * scale * mu_;
}

template <bool kSomeShear>
[[gnu::always_inline]] inline Contact::Change Contact::wanted_change(const Seen& seen, btScalar share) const {
  // Normal: one Newton step of v - give_velocity + softness p = 0, clamped to p >= 0. A contact that is and stays open
  // changes nothing.
  const btScalar velocity = normal_velocity_ + seen.normal;
  const btScalar mass = share == 1 ? normal_mass_ : share / (normal_mobility_ + share * softness_);
  const btScalar normal =
      std::max(normal_impulse_ - (velocity - give_velocity_ + softness_ * normal_impulse_) * mass, btScalar(0));
  const btScalar normal_change = normal - normal_impulse_;
  if (normal <= 0 && normal_impulse_ <= 0 && friction_impulse_[0] == 0 && friction_impulse_[1] == 0)
    return {0, Two{0, 0}, Two{0, 0}};

  // Friction: the slip with the normal's change in it.
  Two friction{0, 0}, slip{0, 0};
  if (normal > 0) {
    slip = slip_ + seen.slip + normal_to_slip_ * normal_change;
    friction =
        kSomeShear && stretch_.to > 0 ? sheared_friction(slip, normal, share) : coulomb_friction(share * slip, normal);
  }
  return {normal_change, friction - friction_impulse_, slip};
}

}  // namespace kenaf::physics
