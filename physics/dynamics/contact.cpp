#include "physics/dynamics/contact.hpp"

#include <algorithm>
#include <cmath>

namespace kenaf::physics {

Contact::Contact(const ContactPatch& patch, const Touch& touch, const ContactSettings& settings, btScalar time_step)
    : normal_impulse_(*touch.stored_impulse[0]),
      friction_impulse_{*touch.stored_impulse[1], *touch.stored_impulse[2]},
      mu_(patch.mu),
      inverse_mu_(patch.inverse_mu),
      stretch_(touch.stretch),
      stored_impulse_{touch.stored_impulse[0], touch.stored_impulse[1], touch.stored_impulse[2]},
      p_W_(touch.p_W) {
  from_a_ = place_at(patch.in_patch(p_W_ - patch.a.p_WC));
  if (patch.b.moves.body) from_b_ = place_at(patch.in_patch(p_W_ - patch.b.p_WC));

  // Spring and damper, implicit: p = -h (k (gap + h v) + d v), p >= 0. Solved for v:
  //   v = -k gap / (h k + d) - p / (h (h k + d)) = give_velocity - softness p
  // The row's residual is v - give_velocity + softness p, its derivative by p is the normal's mobility + softness.
  const btScalar stiffness = settings.stiffness_npm * touch.weight / patch.compliance_scale;
  const btScalar damping = settings.damping_nspm * touch.weight * patch.damping_scale;
  softness_ = 1 / (time_step * (stiffness * time_step + damping));
  give_velocity_ = -stiffness * touch.gap_m * time_step * softness_;
  take_bodies(patch);
}

void Contact::take_bodies(const ContactPatch& patch) {
  const BodyInPatch &a = patch.a, &b = patch.b;
  normal_velocity_ = normal_velocity(a.free_motion, from_a_);
  slip_ = tangential_velocity(a.free_motion, from_a_);
  if (b.moves.body) {
    normal_velocity_ -= normal_velocity(b.free_motion, from_b_);
    slip_ -= tangential_velocity(b.free_motion, from_b_);
  }
  if (a.belt) slip_ += a.gain * a.belt->base_mps;
  if (b.belt) slip_ += b.gain * b.belt->base_mps;

  // The coupling of normal and tangents is used one way only: the effect of the normal impulse on slip.
  const MobilityAtPlace mobility = patch.mobility_at(from_a_, from_b_);
  normal_to_slip_ = mobility.tangents_by_normal;
  normal_mobility_ = mobility.normal;
  normal_mass_ = 1 / (mobility.normal + softness_);

  // Sticking: the impulse -K^-1 slip stops all slip; K is the 2 x 2 matrix of the tangents.
  const btScalar k11 = mobility.tangents[0], k22 = mobility.tangents[1], k12 = mobility.along_by_across;
  const btScalar inverse_determinant = 1 / (k11 * k22 - k12 * k12);
  stick_[0] = Two{k22, -k12} * inverse_determinant;
  stick_[1] = Two{-k12, k11} * inverse_determinant;
  // Sliding: in q = p / mu the limit ellipse is a circle, the slip becomes mu slip and K becomes S = mu K mu. Gradient
  // steps of 1 / (largest eigenvalue of S) converge; it is (s11 + s22) / 2 + sqrt(((s11 - s22) / 2)^2 + s12^2).
  const btScalar s11 = k11 * mu_[0] * mu_[0], s12 = k12 * mu_[0] * mu_[1], s22 = k22 * mu_[1] * mu_[1];
  const btScalar difference = (s11 - s22) / 2;
  const btScalar largest = (s11 + s22) / 2 + std::sqrt(difference * difference + s12 * s12);
  slide_step_ = 1 / largest * mu_;
}

void Contact::keep_impulses() const {
  *stored_impulse_[0] = normal_impulse_;
  *stored_impulse_[1] = friction_impulse_[0];
  *stored_impulse_[2] = friction_impulse_[1];
}

// The impulse lies on the ellipse of p_normal times the share that has built up, where its normal points against the
// slip: p_i = -share p_normal mu_i² slip_i / |mu slip|, which is slip_i = -c_i p_i with a compliance of the row
//   c_i = |mu slip| / (p_normal share mu_i²).
// It is taken at the slip of now and solved with the row, implicitly: however steeply friction rises with slip, the
// impulse never jumps over the one that stops it. c_i grows with the slip, so repeating this comes to rest from one
// side.
[[gnu::noinline]] Two Contact::sheared_friction(Two slip, btScalar normal, btScalar share) const {
  const btScalar speed = std::sqrt(slip[0] * slip[0] + slip[1] * slip[1]);
  const Two scaled_slip = mu_ * slip;
  const btScalar mu = speed > 0 ? std::sqrt(scaled_slip[0] * scaled_slip[0] + scaled_slip[1] * scaled_slip[1]) / speed
                                : std::max(mu_[0], mu_[1]);
  const Two c = mu / (normal * sheared_share_per_slip(stretch_, speed)) * inverse_mu_ * inverse_mu_;

  // slip + K change = -c (p + change), solved for the change; K is the matrix from friction impulse to slip. With S its
  // inverse, which is at hand: (I + S c) change = -S (slip + c p).
  const Two left = slip + c * friction_impulse_;
  const Two stuck = stick_[0] * left[0] + stick_[1] * left[1];
  const Two column_0 = Two{1, 0} + stick_[0] * c[0], column_1 = Two{0, 1} + stick_[1] * c[1];
  const btScalar determinant = column_0[0] * column_1[1] - column_1[0] * column_0[1];
  const Two change =
      Two{column_1[1] * stuck[0] - column_1[0] * stuck[1], column_0[0] * stuck[1] - column_0[1] * stuck[0]} /
      -determinant;
  const Two friction = friction_impulse_ + share * change;

  // Never more than all of the friction, on the way there.
  const Two q = friction * inverse_mu_;
  const btScalar length = std::sqrt(q[0] * q[0] + q[1] * q[1]);
  return length > normal ? friction * (normal / length) : friction;
}

}  // namespace kenaf::physics
