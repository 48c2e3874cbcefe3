#include "physics/dynamics/contact_patch.hpp"

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

// What depends on the servos of the body that `of` moves, in the axes of the patch.
void take_body(BodyInPatch& of, const ContactPatch& patch) {
  const ArticulatedBody& body = *of.moves.body;
  of.loose_count = body.loose_count;
  for (std::size_t i = 0; i < body.loose_count; ++i) of.loose[i] = patch.in_patch(body.loose[i]);
  TwoVectors motion_W = side_by_side(body.v, body.w);
  of.arm_mobility = 0;
  if (const Arm* arm = of.moves.arm) {
    // The arm turns about its pivot: as a motion of C, spin x (C - pivot) and spin.
    const btVector3 spin = arm->bias_w + arm->axis_W * arm->rate, to_C = body.p_WC - arm->pivot_W;
    motion_W += side_by_side(arm->bias_v + spin.cross(to_C), spin);
    of.unit_rate = patch.in_patch(side_by_side(arm->axis_W.cross(to_C), arm->axis_W));
    of.arm_mobility = arm->mobility;
    if (arm->mobility > 0) {
      const TwoVectors response = body.response(arm->coupling);
      of.response = patch.in_patch(response);
      of.arm_alone = arm->mobility * (1 + arm->mobility * sum_of_lanes(dot(arm->coupling, response)));
    }
  }
  of.free_motion = patch.in_patch(motion_W);
}

void set_body(BodyInPatch& of, const ContactPatch& patch, const ContactSide& moves) {
  of.moves = moves;
  if (!moves.body) return;
  const ArticulatedBody& body = *moves.body;
  of.p_WC = body.p_WC;
  of.inverse_mass = body.inverse_mass;
  const btMatrix3x3& inverse = body.inverse_inertia_W;
  const btVector3 by_along = patch.in_patch(inverse * patch.along_W);
  const btVector3 by_across = patch.in_patch(inverse * patch.across_W);
  const btVector3 by_normal = patch.in_patch(inverse * patch.normal_W);
  of.turn_by_along = Two{by_along.x(), by_along.y()};
  of.turn_by_across = Two{by_across.x(), by_across.y()};
  of.turn_by_normal = Two{by_normal.x(), by_normal.y()};
  of.turn_n_by_n = by_normal.z();
}

void set_belt(BodyInPatch& of, const ContactPatch& patch, Belt* belt, const btVector3& gain_W) {
  of.belt = belt;
  if (belt) of.gain = Two{patch.along_W.dot(gain_W), patch.across_W.dot(gain_W)};
}

// Products of two places' velocities along the axes.
MobilityAtPlace products(btScalar normal_1, Two tangents_1, btScalar normal_2, Two tangents_2) {
  return {normal_1 * normal_2, (tangents_1[0] * tangents_2[1] + tangents_1[1] * tangents_2[0]) / 2,
          tangents_1 * tangents_2, (tangents_1 * normal_2 + tangents_2 * normal_1) / 2};
}
MobilityAtPlace operator*(const MobilityAtPlace& m, btScalar s) {
  return {m.normal * s, m.along_by_across * s, m.tangents * s, m.tangents_by_normal * s};
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

void BodyInPatch::add_yielding(InPatch& change, const InPatch& impulse) const {
  for (std::size_t i = 0; i < loose_count; ++i) change = change + loose[i] * dot(loose[i], impulse);
  if (arm_mobility > 0) {
    const btScalar on_arm = dot(unit_rate, impulse);
    change = change + unit_rate * (arm_alone * on_arm - arm_mobility * dot(response, impulse)) -
             response * (arm_mobility * on_arm);
  }
}

void BodyInPatch::add_yielding(MobilityAtPlace& m, const PlaceInPatch& r) const {
  const auto velocities = [&](const InPatch& motion, const InPatch& other) {
    return products(normal_velocity(motion, r), tangential_velocity(motion, r), normal_velocity(other, r),
                    tangential_velocity(other, r));
  };
  for (std::size_t i = 0; i < loose_count; ++i) m += velocities(loose[i], loose[i]);
  if (arm_mobility > 0) {
    m += velocities(unit_rate, unit_rate) * arm_alone;
    m += velocities(unit_rate, response) * (-2 * arm_mobility);
  }
}

ContactPatch::ContactPatch(const Meeting& meeting, const btVector3& normal, bool with_lugs)
    : collider_a(meeting.collider_a),
      collider_b(meeting.collider_b),
      part_a(meeting.surface_a->part),
      part_b(meeting.surface_b->part),
      normal_W(normal),
      compliance_scale(meeting.surface_a->compliance_scale * meeting.surface_b->compliance_scale),
      damping_scale(meeting.surface_a->damping_scale * meeting.surface_b->damping_scale),
      fading(meeting.warm_start_share),
      holds_lugs(with_lugs) {
  const Surface &surface_a = *meeting.surface_a, &surface_b = *meeting.surface_b;
  // Velocity of the belt's surface for a belt speed of -1: n x axis, along the belt, shorter towards the side faces.
  // Drake's multibody plant defines surface velocity in the same way (speed * axis x normal).
  const btVector3 belt_a = surface_a.belt ? (-normal).cross(meeting.belt_axis_a) : btVector3(0, 0, 0);
  const btVector3 belt_b = surface_b.belt ? normal.cross(meeting.belt_axis_b) : btVector3(0, 0, 0);

  // The axes of friction: along a belt, A's before B's; on a side face and without a belt any tangent, isotropic.
  btScalar mu_along = surface_a.friction_along * surface_b.friction_along;
  const btScalar mu_across = surface_a.friction_across * surface_b.friction_across;
  if (holds_lugs) mu_along = grip_at_edge(mu_along, surface_a.lug_height_m);
  if (belt_a.length2() > kSideFace * kSideFace) {
    along_W = belt_a.normalized();
  } else if (belt_b.length2() > kSideFace * kSideFace) {
    along_W = belt_b.normalized();
  } else {
    btVector3 unused;
    btPlaneSpace1(normal, along_W, unused);
    mu_along = mu_across;
  }
  across_W = normal.cross(along_W);
  mu = Two{std::max(mu_along, kLeastFriction), std::max(mu_across, kLeastFriction)};
  inverse_mu = 1 / mu;

  // A belt of speed u adds gain u to the slip; a friction impulse p pushes it with gain . p.
  set_body(a, *this, meeting.side_a);
  set_body(b, *this, meeting.side_b);
  set_belt(a, *this, surface_a.belt, -belt_a * meeting.driving_a);
  set_belt(b, *this, surface_b.belt, belt_b * meeting.driving_b);
  take_bodies();
}

void ContactPatch::take_bodies() {
  take_body(a, *this);
  if (b.moves.body) take_body(b, *this);
}

InPatch ContactPatch::in_patch(const TwoVectors& v_W) const {
  const Two along = dot(along_W, v_W), across = dot(across_W, v_W), normal = dot(normal_W, v_W);
  return {Two{along[0], across[0]}, Two{along[1], across[1]}, normal[0], normal[1]};
}

TwoVectors ContactPatch::in_W(const InPatch& v) const {
  const Two along{v.linear[0], v.angular[0]}, across{v.linear[1], v.angular[1]}, normal{v.linear_n, v.angular_n};
  return {along_W.x() * along + across_W.x() * across + normal_W.x() * normal,
          along_W.y() * along + across_W.y() * across + normal_W.y() * normal,
          along_W.z() * along + across_W.z() * across + normal_W.z() * normal};
}

InPatch ContactPatch::seen(const BodyInPatch& of) const {
  const ArticulatedBody& body = *of.moves.body;
  const InPatch motion = in_patch(body.delta);
  if (of.arm_mobility == 0) return motion;
  const Arm& arm = *of.moves.arm;
  return motion + of.unit_rate * (arm.mobility * (arm.push_nms - sum_of_lanes(dot(arm.coupling, body.delta))));
}

// The push on an arm about its axis and, where its servo yields, what the base does not feel of it.
void ContactPatch::give(const BodyInPatch& to, const InPatch& impulse) const {
  TwoVectors impulse_W = in_W(impulse);
  if (Arm* arm = to.moves.arm) {
    const btScalar push_nms = dot(to.unit_rate, impulse);
    arm->push_nms += push_nms;
    impulse_W -= arm->coupling * (arm->mobility * push_nms);
  }
  to.moves.body->delta += to.moves.body->response(impulse_W);
}

// Of two arms of one body: the impulses on the base cancel but for what the arms keep of them.
MobilityAtPlace ContactPatch::mobility_between_arms(const PlaceInPatch& from_a, const PlaceInPatch& from_b) const {
  constexpr btScalar kTrifle = 1e-9;  // of the body's, so that arms which hold have some
  MobilityAtPlace m{kTrifle * a.inverse_mass, 0, Two{1, 1} * (kTrifle * a.inverse_mass), Two{0, 0}};
  struct Lever {
    btScalar normal = 0;
    Two tangents{0, 0};
  };
  const auto lever_of = [](const BodyInPatch& of, const PlaceInPatch& r) {
    return of.arm_mobility > 0 ? Lever{normal_velocity(of.unit_rate, r), tangential_velocity(of.unit_rate, r)}
                               : Lever{};
  };
  const Lever of_a = lever_of(a, from_a), of_b = lever_of(b, from_b);
  m += products(of_a.normal, of_a.tangents, of_a.normal, of_a.tangents) * a.arm_alone;
  m += products(of_b.normal, of_b.tangents, of_b.normal, of_b.tangents) * b.arm_alone;
  if (a.arm_mobility > 0 && b.arm_mobility > 0) {
    const btScalar between = sum_of_lanes(dot(a.moves.arm->coupling, a.moves.body->response(b.moves.arm->coupling)));
    m += products(of_a.normal, of_a.tangents, of_b.normal, of_b.tangents) *
         (-2 * a.arm_mobility * b.arm_mobility * between);
  }
  return m;
}

}  // namespace kenaf::physics
