#include "physics/dynamics/contact.hpp"

#include <algorithm>
#include <cmath>

namespace kenaf::physics {
namespace {

constexpr btScalar kLeastFriction = 1e-6;  // keeps the friction ellipse regular where a surface slides freely
constexpr btScalar kEdgeRadius_m = 0.01;   // of timber and concrete
constexpr btScalar kMostGrip = 10;         // a lug that is wholly behind an edge
// |normal x belt axis| below which a surface is a side face, where no direction is along the belt. Below the kSideways
// of belt_contacts.cpp, which sorts contacts by shape, so that all contacts of a belt's outline have their direction.
constexpr btScalar kSideFace = 0.1;

// An edge is slightly round, and a lug that meets it is to it as a step is to a wheel: the lug's corner presses on the
// edge at an angle b from the belt's normal, cos b = 1 - height / radius. With tan a = mu it holds up to
//   tan(a + b) = (mu cos b + sin b) / (cos b - mu sin b), at most kMostGrip, which also covers a + b >= 90 degrees.
btScalar grip_at_edge(btScalar mu, btScalar lug_height_m) {
  if (lug_height_m <= 0) return mu;
  const btScalar cosine = 1 - std::min(lug_height_m / kEdgeRadius_m, btScalar(1));
  const btScalar sine = std::sqrt(1 - cosine * cosine);
  const btScalar rise = mu * cosine + sine, run = cosine - mu * sine;
  return rise < kMostGrip * run ? rise / run : kMostGrip;
}

btVector3 belt_axis(const Surface& surface, const btCollisionObject& body) {
  return surface.belt ? body.getWorldTransform().getBasis().getColumn(1) * surface.axis_y : btVector3(0, 0, 0);
}

// The share of a belt's speed that moves its surface.
btScalar driving_share(const Belt* belt) {
  return belt ? 1 - std::min(belt->slip_spm * std::abs(belt->speed_mps), 1.0) : 0;
}

// A belt of prescribed speed: its motor supplies the impulse that the contact takes from the belt.
void hold_against(Belt& belt, Two gain, Two friction_impulse) {
  if (std::isinf(belt.moving_mass_kg))
    belt.motor_impulse_ns -= gain[0] * friction_impulse[0] + gain[1] * friction_impulse[1];
}

// Interleaves a linear and an angular part into the three rows normal, along, across.
void set_rows(TwoVectors rows[3], const btVector3& normal, const btVector3& arm, const TwoVectors& tangents,
              const TwoVectors& arms) {
  rows[0] = side_by_side(normal, arm);
  rows[1] = lanes(tangents, arms, 0);
  rows[2] = lanes(tangents, arms, 1);
}

}  // namespace

Meeting::Meeting(const btCollisionObject& a, const btCollisionObject& b, SolverBody* solver_a, SolverBody* solver_b,
                 const Surface& on_a, const Surface& on_b)
    : collider_a(static_cast<const Collider*>(a.getUserPointer())),
      collider_b(static_cast<const Collider*>(b.getUserPointer())),
      body_a(solver_a),
      body_b(solver_b),
      surface_a(&on_a),
      surface_b(&on_b),
      belt_axis_a(belt_axis(on_a, a)),
      belt_axis_b(belt_axis(on_b, b)),
      driving_a(driving_share(on_a.belt)),
      driving_b(driving_share(on_b.belt)),
      warm_start_share(
          std::min(on_a.belt ? on_a.belt->warm_start_share : 1, on_b.belt ? on_b.belt->warm_start_share : 1)) {}

Contact::Contact(const Meeting& meeting, const Touch& touch, const ContactSettings& settings, btScalar time_step)
    : body_a_(meeting.body_a),
      body_b_(meeting.body_b),
      belt_a_(meeting.surface_a->belt),
      belt_b_(meeting.surface_b->belt),
      inverse_mass_a_(body_a_->inverse_mass),
      stretch_(touch.stretch),
      stored_impulse_{touch.stored_impulse[0], touch.stored_impulse[1], touch.stored_impulse[2]},
      collider_a_(meeting.collider_a),
      collider_b_(meeting.collider_b),
      p_W_(touch.p_W),
      part_a_(meeting.surface_a->part),
      part_b_(meeting.surface_b->part) {
  const Surface &surface_a = *meeting.surface_a, &surface_b = *meeting.surface_b;
  const btVector3& normal = touch.normal_W;
  // Velocity of the belt's surface for a belt speed of -1: n x axis, along the belt, shorter towards the side faces.
  // Drake's multibody plant defines surface velocity in the same way (speed * axis x normal).
  const btVector3 belt_a = belt_a_ ? (-normal).cross(meeting.belt_axis_a) : btVector3(0, 0, 0);
  const btVector3 belt_b = belt_b_ ? normal.cross(meeting.belt_axis_b) : btVector3(0, 0, 0);

  // The axes of friction: along a belt, A's before B's; on a side face and without a belt any tangent, isotropic.
  btScalar mu_along = surface_a.friction_along * surface_b.friction_along;
  const btScalar mu_across = surface_a.friction_across * surface_b.friction_across;
  if (touch.holds_lugs) mu_along = grip_at_edge(mu_along, surface_a.lug_height_m);
  btVector3 along;
  if (belt_a.length2() > kSideFace * kSideFace) {
    along = belt_a.normalized();
  } else if (belt_b.length2() > kSideFace * kSideFace) {
    along = belt_b.normalized();
  } else {
    btVector3 unused;
    btPlaneSpace1(normal, along, unused);
    mu_along = mu_across;
  }
  // From here on the two tangents are worked on side by side.
  const TwoVectors tangents = side_by_side(along, normal.cross(along));

  // A belt of speed u adds gain u to the slip; a friction impulse p changes its speed by gain . p / m_b.
  belt_gain_a_ = belt_gain_b_ = belt_push_a_ = belt_push_b_ = Two{0, 0};
  if (belt_a_) {
    belt_gain_a_ = -dot(belt_a, tangents) * meeting.driving_a;
    belt_push_a_ = belt_gain_a_ / belt_a_->moving_mass_kg;
  }
  if (belt_b_) {
    belt_gain_b_ = dot(belt_b, tangents) * meeting.driving_b;
    belt_push_b_ = belt_gain_b_ / belt_b_->moving_mass_kg;
  }

  // Effective inverse masses K = J M^-1 J^T: k00 of the normal, k11, k12, k22 of the tangents. With rows (n, r x n)
  //   K_ij = (1 / m) n_i . n_j + (r x n_i) . I^-1 (r x n_j)   for each body;
  // the axes are orthogonal, so 1 / m enters the diagonal only. The coupling of normal and tangents is used one way
  // only: the effect of the normal impulse on slip.
  btScalar k00, k12;
  Two k11_k22;
  const SolverBody& A = *body_a_;
  const btVector3 r_a = p_W_ - A.p_W;
  btVector3 velocity = A.v + A.w.cross(r_a);
  {
    const btVector3 arm = r_a.cross(normal), turn = A.inverse_inertia_W * arm;
    const TwoVectors arms = cross(r_a, tangents), turns = A.inverse_inertia_W * arms;
    set_rows(row_, normal, arm, tangents, arms);
    set_rows(response_, normal * A.inverse_mass, turn, tangents * A.inverse_mass, turns);
    k00 = arm.dot(turn);
    k11_k22 = dot(arms, turns);
    k12 = vector_of(arms, 0).dot(vector_of(turns, 1));
    normal_to_slip_ = dot(turn, arms);
  }
  btScalar inverse_mass = A.inverse_mass;
  if (body_b_) {
    const SolverBody& B = *body_b_;
    const btVector3 r_b = p_W_ - B.p_W;
    velocity -= B.v + B.w.cross(r_b);
    const btVector3 arm = r_b.cross(normal), turn = B.inverse_inertia_W * arm;
    const TwoVectors arms = cross(r_b, tangents), turns = B.inverse_inertia_W * arms;
    set_rows(row_b_, normal, arm, tangents, arms);
    set_rows(response_b_, normal, turn, tangents, turns);
    k00 += arm.dot(turn);
    k11_k22 += dot(arms, turns);
    k12 += vector_of(arms, 0).dot(vector_of(turns, 1));
    normal_to_slip_ += dot(turn, arms);
    inverse_mass += B.inverse_mass;
  }

  // The shares of mass, and of the belts: gain gain^T / m_b.
  k00 += inverse_mass;
  k11_k22 = k11_k22 + inverse_mass + (belt_gain_a_ * belt_push_a_ + belt_gain_b_ * belt_push_b_);
  k12 += belt_gain_a_[0] * belt_push_a_[1] + belt_gain_b_[0] * belt_push_b_[1];
  normal_velocity_ = normal.dot(velocity);
  slip_ = dot(velocity, tangents);

  // Spring and damper, implicit: p = -h (k (gap + h v) + d v), p >= 0. Solved for v:
  //   v = -k gap / (h k + d) - p / (h (h k + d)) = give_velocity - softness p
  // The row's residual is v - give_velocity + softness p, its derivative by p is k00 + softness.
  const btScalar stiffness =
      settings.stiffness_npm * touch.weight / (surface_a.compliance_scale * surface_b.compliance_scale);
  const btScalar damping = settings.damping_nspm * touch.weight * surface_a.damping_scale * surface_b.damping_scale;
  const btScalar step_stiffness = stiffness * time_step + damping;
  softness_ = 1 / (time_step * step_stiffness);
  give_velocity_ = -stiffness * touch.gap_m / step_stiffness;
  normal_mass_ = 1 / (k00 + softness_);

  // Sticking: the impulse -K^-1 slip stops all slip; K is the 2 x 2 matrix of the tangents.
  mu_ = Two{std::max(mu_along, kLeastFriction), std::max(mu_across, kLeastFriction)};
  inverse_mu_ = 1 / mu_;
  const btScalar k11 = k11_k22[0], k22 = k11_k22[1];
  const btScalar inverse_determinant = 1 / (k11 * k22 - k12 * k12);
  stick_[0] = Two{k22, -k12} * inverse_determinant;
  stick_[1] = Two{-k12, k11} * inverse_determinant;
  // Sliding: in q = p / mu the limit ellipse is a circle, the slip becomes mu slip and K becomes S = mu K mu. Gradient
  // steps of 1 / (largest eigenvalue of S) converge; it is (s11 + s22) / 2 + sqrt(((s11 - s22) / 2)^2 + s12^2).
  const btScalar s11 = k11 * mu_[0] * mu_[0], s12 = k12 * mu_[0] * mu_[1], s22 = k22 * mu_[1] * mu_[1];
  const btScalar difference = (s11 - s22) / 2;
  const btScalar largest = (s11 + s22) / 2 + std::sqrt(difference * difference + s12 * s12);
  slide_step_ = 1 / largest * mu_;

  // The last step's impulses to start from.
  normal_impulse_ = *touch.stored_impulse[0];
  friction_impulse_ = meeting.warm_start_share * Two{*touch.stored_impulse[1], *touch.stored_impulse[2]};
}

// Inline: as a call it makes the computation of a time step 8 % slower.
template <bool kOnGround>
[[gnu::always_inline]] inline void Contact::apply(Moved a, btScalar normal, Two friction) {
  a.delta += response_[0] * normal + response_[1] * friction[0] + response_[2] * friction[1];
  if (belt_a_) {
    a.load_ns += normal;
    a.belt_mps += belt_push_a_[0] * friction[0] + belt_push_a_[1] * friction[1];
  }
  if constexpr (kOnGround) return;
  if (body_b_) {
    const Two inverse_mass{body_b_->inverse_mass, 1};  // the linear part of response_b_ lacks it
    body_b_->delta -=
        (response_b_[0] * normal + response_b_[1] * friction[0] + response_b_[2] * friction[1]) * inverse_mass;
  }
  if (belt_b_) {
    belt_b_->load_ns += normal;
    belt_b_->speed_mps += belt_push_b_[0] * friction[0] + belt_push_b_[1] * friction[1];
  }
}

void Contact::warm_start() {
  btScalar none = 0;
  apply<false>(in_place(none), normal_impulse_, friction_impulse_);
}

[[gnu::always_inline]] inline Two Contact::coulomb_friction(Two slip, btScalar normal) const {
  // Sticking: the impulse that stops the slip, if it lies within the limit ellipse.
  const Two friction = friction_impulse_ - stick_[0] * slip[0] - stick_[1] * slip[1];
  const Two scaled = friction * inverse_mu_;
  if (scaled[0] * scaled[0] + scaled[1] * scaled[1] <= normal * normal) return friction;
  // Sliding: projected gradient step, q - mu slip / eigenvalue, then back onto the circle of radius p_normal. Its fixed
  // point is the impulse of maximum dissipation: there the ellipse's normal points against the slip.
  const Two q = friction_impulse_ * inverse_mu_ - slide_step_ * slip;
  const btScalar length = std::sqrt(q[0] * q[0] + q[1] * q[1]);
  const btScalar scale = length > normal ? normal / length : 1;
  return q * scale * mu_;
}

// The impulse lies on the ellipse of p_normal times the share that has built up, where its normal points against the
// slip: p_i = -share p_normal mu_i² slip_i / |mu slip|, which is slip_i = -c_i p_i with a compliance of the row
//   c_i = |mu slip| / (p_normal share mu_i²).
// It is taken at the slip of now and solved with the row, implicitly: however steeply friction rises with slip, the
// impulse never jumps over the one that stops it. c_i grows with the slip, so repeating this comes to rest from one
// side.
[[gnu::noinline]] Two Contact::sheared_friction(Two slip, btScalar normal) const {
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
  const Two friction = friction_impulse_ + change;

  // Never more than all of the friction, on the way there.
  const Two q = friction * inverse_mu_;
  const btScalar length = std::sqrt(q[0] * q[0] + q[1] * q[1]);
  return length > normal ? friction * (normal / length) : friction;
}

template <bool kOnGround, bool kSomeShear>
[[gnu::always_inline]] inline btScalar Contact::solve_one(Moved a) {
  // Velocity change of A relative to B, without B's angular part, whose rows have arms of their own.
  const bool b_moves = !kOnGround && body_b_;
  TwoVectors relative = a.delta;
  if (b_moves) {
    const TwoVectors& b = body_b_->delta;
    relative -= {Two{b.x[0], 0}, Two{b.y[0], 0}, Two{b.z[0], 0}};
  }

  // Normal: one Newton step of v - give_velocity + softness p = 0, clamped to p >= 0. A contact that is and stays open
  // changes nothing.
  const Two normal_parts = dot(row_[0], relative);
  btScalar velocity = normal_velocity_ + normal_parts[0] + normal_parts[1];
  if (b_moves) velocity -= dot(row_b_[0], body_b_->delta)[1];
  const btScalar normal =
      std::max(normal_impulse_ - (velocity - give_velocity_ + softness_ * normal_impulse_) * normal_mass_, btScalar(0));
  const btScalar normal_change = normal - normal_impulse_;
  if (normal <= 0 && normal_impulse_ <= 0 && friction_impulse_[0] == 0 && friction_impulse_[1] == 0) return 0;

  // Friction: the slip with the normal's change and the belts' speeds in it.
  Two friction{0, 0};
  if (normal > 0) {
    const Two along = dot(row_[1], relative), across = dot(row_[2], relative);
    Two slip = slip_ + Two{along[0], across[0]} + Two{along[1], across[1]};
    if (b_moves) slip -= Two{dot(row_b_[1], body_b_->delta)[1], dot(row_b_[2], body_b_->delta)[1]};
    slip += normal_to_slip_ * normal_change;
    if (belt_a_) slip += belt_gain_a_ * a.belt_mps;
    if (!kOnGround && belt_b_) slip += belt_gain_b_ * belt_b_->speed_mps;
    friction = kSomeShear && stretch_.to > 0 ? sheared_friction(slip, normal) : coulomb_friction(slip, normal);
  }

  // Apply the changes; the residual is the squared linear velocity change of A.
  const Two friction_change = friction - friction_impulse_;
  normal_impulse_ = normal;
  friction_impulse_ = friction;
  apply<kOnGround>(a, normal_change, friction_change);
  return (normal_change * normal_change + friction_change[0] * friction_change[0] +
          friction_change[1] * friction_change[1]) *
         inverse_mass_a_ * inverse_mass_a_;
}

Contact::Moved Contact::in_place(btScalar& none) const {
  if (!belt_a_) return {body_a_->delta, none, none};
  return {body_a_->delta, belt_a_->speed_mps, belt_a_->load_ns};
}

template <bool kSomeShear>
btScalar Contact::solve_each(std::span<Contact> contacts) {
  btScalar residual = 0, none = 0;
  for (auto next = contacts.begin(); next != contacts.end();) {
    const Contact& first = *next;
    const Moved place = first.in_place(none);
    // Between moving things: one at a time, in place.
    if (!first.on_ground()) {
      residual = std::max(residual, next->solve_one<false, kSomeShear>(place));
      ++next;
      continue;
    }
    // The contacts of one body on fixed ground: A's state stays in registers from contact to contact. Through memory,
    // the computation of a time step is 3 % slower.
    TwoVectors delta = place.delta;
    btScalar belt_mps = place.belt_mps, load_ns = place.load_ns;
    for (; next != contacts.end() && next->on_ground() && next->body_a_ == first.body_a_ &&
           next->belt_a_ == first.belt_a_;
         ++next)
      residual = std::max(residual, next->solve_one<true, kSomeShear>({delta, belt_mps, load_ns}));
    place.delta = delta;
    place.belt_mps = belt_mps;
    place.load_ns = load_ns;
  }
  return residual;
}

btScalar Contact::solve(std::span<Contact> contacts, bool some_shear) {
  return some_shear ? solve_each<true>(contacts) : solve_each<false>(contacts);
}

void Contact::finish() {
  *stored_impulse_[0] = normal_impulse_;
  *stored_impulse_[1] = friction_impulse_[0];
  *stored_impulse_[2] = friction_impulse_[1];
  if (belt_a_) hold_against(*belt_a_, belt_gain_a_, friction_impulse_);
  if (belt_b_) hold_against(*belt_b_, belt_gain_b_, friction_impulse_);
}

}  // namespace kenaf::physics
