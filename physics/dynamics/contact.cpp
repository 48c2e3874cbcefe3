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

}  // namespace

Meeting::Meeting(const btCollisionObject& a, const btCollisionObject& b, const ContactSide& moves_a,
                 const ContactSide& moves_b, const Surface& on_a, const Surface& on_b)
    : collider_a(static_cast<const Collider*>(a.getUserPointer())),
      collider_b(static_cast<const Collider*>(b.getUserPointer())),
      side_a(moves_a),
      side_b(moves_b),
      surface_a(&on_a),
      surface_b(&on_b),
      belt_axis_a(belt_axis(on_a, a)),
      belt_axis_b(belt_axis(on_b, b)),
      driving_a(driving_share(on_a.belt)),
      driving_b(driving_share(on_b.belt)),
      warm_start_share(
          std::min(on_a.belt ? on_a.belt->warm_start_share : 1, on_b.belt ? on_b.belt->warm_start_share : 1)) {}

// What a unit impulse changes along the rows: of the normal itself, of the tangents themselves, of one tangent by the
// other, and of the tangents by the normal. (K = J M^-1 J^T; an arm whose servo yields adds lever_i lever_j g.)
struct Contact::Mobility {
  btScalar normal, coupled;
  Two tangents, normal_to_slip;

  void operator+=(const Mobility& b) {
    normal += b.normal;
    coupled += b.coupled;
    tangents += b.tangents;
    normal_to_slip += b.normal_to_slip;
  }
};

Contact::Mobility Contact::mobility_of(const Rows& of, const Arm* arm) {
  const auto parts = [&](int i, int j) { return sum_of_lanes(dot(of.row[i], of.response[j])); };
  Mobility m{parts(0, 0), parts(1, 2), Two{parts(1, 1), parts(2, 2)}, Two{parts(1, 0), parts(2, 0)}};
  if (!arm || arm->mobility == 0) return m;
  m += {of.lever * of.lever * arm->mobility, of.levers[0] * of.levers[1] * arm->mobility,
        of.levers * of.levers * arm->mobility, of.levers * (of.lever * arm->mobility)};
  return m;
}

// With r from C to the point and the lever l = axis x (p - pivot) of an arm, an axis n of the contact has the row
//   (n, r x n) - (l . n) g c
// in which the rate of the arm is g (push - c . velocity), with g = 0 while its servo holds.
[[gnu::always_inline]] inline Contact::Mobility Contact::set_rows(Rows& rows, const ContactSide& side,
                                                                  const btVector3& p_W, const btVector3& normal,
                                                                  const TwoVectors& tangents) {
  const ArticulatedBody& body = *side.body;
  const btVector3 r = p_W - body.p_WC, moment = r.cross(normal);
  const TwoVectors moments = cross(r, tangents);
  rows.row[0] = side_by_side(normal, moment);
  rows.row[1] = lanes(tangents, moments, 0);
  rows.row[2] = lanes(tangents, moments, 1);
  if (side.arm) {
    const btVector3 lever = side.arm->axis_W.cross(p_W - side.arm->pivot_W);
    rows.lever = lever.dot(normal);
    rows.levers = dot(lever, tangents);
  }
  if (body.loose_count > 0) {
    if (side.arm && side.arm->mobility > 0) {
      const TwoVectors follows = side.arm->coupling * side.arm->mobility;
      rows.row[0] -= follows * rows.lever;
      rows.row[1] -= follows * rows.levers[0];
      rows.row[2] -= follows * rows.levers[1];
    }
    for (int i = 0; i < 3; ++i) rows.response[i] = body.response(rows.row[i]);
    return mobility_of(rows, side.arm);
  }
  // All servos hold: 1 / m enters the diagonal only, as the axes are orthogonal, and the tangents are worked on side by
  // side.
  const btVector3 turn = body.inverse_inertia_W * moment;
  const TwoVectors turns = body.inverse_inertia_W * moments;
  rows.response[0] = side_by_side(normal * body.inverse_mass, turn);
  rows.response[1] = lanes(tangents * body.inverse_mass, turns, 0);
  rows.response[2] = lanes(tangents * body.inverse_mass, turns, 1);
  return {body.inverse_mass + moment.dot(turn), vector_of(moments, 0).dot(vector_of(turns, 1)),
          body.inverse_mass + dot(moments, turns), dot(turn, moments)};
}

Contact::Contact(const Meeting& meeting, const Touch& touch, const ContactSettings& settings, btScalar time_step)
    : a_(meeting.side_a),
      b_(meeting.side_b),
      belt_a_(meeting.surface_a->belt),
      belt_b_(meeting.surface_b->belt),
      inverse_mass_a_(a_.body->inverse_mass),
      fading_(meeting.warm_start_share),
      stretch_(touch.stretch),
      stored_impulse_{touch.stored_impulse[0], touch.stored_impulse[1], touch.stored_impulse[2]},
      collider_a_(meeting.collider_a),
      collider_b_(meeting.collider_b),
      p_W_(touch.p_W),
      normal_W_(touch.normal_W),
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
  tangents_W_ = tangents;

  // A belt of speed u adds gain u to the slip; a friction impulse p pushes it with gain . p.
  gain_a_ = gain_b_ = Two{0, 0};
  if (belt_a_) gain_a_ = -dot(belt_a, tangents) * meeting.driving_a;
  if (belt_b_) gain_b_ = dot(belt_b, tangents) * meeting.driving_b;

  // The coupling of normal and tangents is used one way only: the effect of the normal impulse on slip.
  Mobility mobility = set_rows(rows_a_, a_, p_W_, normal, tangents);
  btVector3 velocity = velocity_without_contacts(*a_.body, a_.arm, p_W_);
  if (b_.body) {
    mobility += set_rows(rows_b_, b_, p_W_, normal, tangents);
    velocity -= velocity_without_contacts(*b_.body, b_.arm, p_W_);
    if (b_.body == a_.body) mobility = merge_rows();
  }
  normal_to_slip_ = mobility.normal_to_slip;
  normal_velocity_ = normal.dot(velocity);

  // Belts that their motors do not hold: gain gain^T times the mobility.
  slip_ = dot(velocity, tangents);
  const auto add_belt = [&](const Belt& belt, Two gain) {
    mobility.tangents += gain * gain * belt.mobility_per_kg;
    mobility.coupled += gain[0] * gain[1] * belt.mobility_per_kg;
    slip_ += gain * belt.base_mps;
  };
  if (belt_a_) add_belt(*belt_a_, gain_a_);
  if (belt_b_) add_belt(*belt_b_, gain_b_);

  // Spring and damper, implicit: p = -h (k (gap + h v) + d v), p >= 0. Solved for v:
  //   v = -k gap / (h k + d) - p / (h (h k + d)) = give_velocity - softness p
  // The row's residual is v - give_velocity + softness p, its derivative by p is the normal's mobility + softness.
  const btScalar stiffness =
      settings.stiffness_npm * touch.weight / (surface_a.compliance_scale * surface_b.compliance_scale);
  const btScalar damping = settings.damping_nspm * touch.weight * surface_a.damping_scale * surface_b.damping_scale;
  softness_ = 1 / (time_step * (stiffness * time_step + damping));
  give_velocity_ = -stiffness * touch.gap_m * time_step * softness_;
  normal_mobility_ = mobility.normal;
  normal_mass_ = 1 / (mobility.normal + softness_);

  // Sticking: the impulse -K^-1 slip stops all slip; K is the 2 x 2 matrix of the tangents.
  mu_ = Two{std::max(mu_along, kLeastFriction), std::max(mu_across, kLeastFriction)};
  inverse_mu_ = 1 / mu_;
  const btScalar k11 = mobility.tangents[0], k22 = mobility.tangents[1], k12 = mobility.coupled;
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
  friction_impulse_ = Two{*touch.stored_impulse[1], *touch.stored_impulse[2]};
}

// Of two arms of one body: what the two rows do to the body is their difference, in A's; their levers stay apart.
Contact::Mobility Contact::merge_rows() {
  for (int i = 0; i < 3; ++i) {
    rows_a_.row[i] -= rows_b_.row[i];
    rows_a_.response[i] -= rows_b_.response[i];
    rows_b_.row[i] = rows_b_.response[i] = TwoVectors{};
  }
  Mobility mobility = mobility_of(rows_a_, a_.arm);
  mobility += mobility_of(rows_b_, b_.arm);
  return mobility;
}

void Contact::count() const {
  if (normal_impulse_ <= 0 && normal_velocity_ >= give_velocity_) return;
  ++a_.body->contact_count;
  if (b_.body) ++b_.body->contact_count;
}

void Contact::keep_impulses() const {
  *stored_impulse_[0] = normal_impulse_;
  *stored_impulse_[1] = friction_impulse_[0];
  *stored_impulse_[2] = friction_impulse_[1];
}

bool Contact::sticks() const {
  constexpr btScalar kSlides_mps = 1e-4;  // as kStanding_mps of shear.cpp
  return pressed() && last_slip_[0] * last_slip_[0] + last_slip_[1] * last_slip_[1] <= kSlides_mps * kSlides_mps;
}

void Contact::fade() {
  friction_impulse_ *= Two{fading_, fading_};
}

bool Contact::moves_base_alone() const {
  return on_ground() && (!a_.arm || a_.arm->mobility == 0) && (!belt_a_ || belt_a_->mobility_per_kg == 0);
}

void Contact::lose_to(FrictionCreep& creep) const {
  creep.lose({rows_a_.row[1], rows_a_.row[2]}, (1 - fading_) * friction_impulse_, normal_impulse_);
}

void Contact::add_spring_to(FrictionCreep& creep) const {
  creep.add_spring({rows_a_.row[1], rows_a_.row[2]}, normal_impulse_);
}

void Contact::take_back(const TwoVectors& given_back) {
  friction_impulse_ += normal_impulse_ * Two{sum_of_lanes(dot(rows_a_.row[1], given_back)),
                                             sum_of_lanes(dot(rows_a_.row[2], given_back))};
}

}  // namespace kenaf::physics
