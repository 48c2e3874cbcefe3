// Contacts of two bodies that have one normal, such as a belt's on a face of the ground. What they have in common is
// computed once, in the patch's axes F: along the belt, across it, and the normal. There a contact is no more than a
// place, and a body's motion gives the velocities of all places by a few products. docs/physics.md has the equations.
//
// Thread safety: values; a patch by one thread, as it moves its bodies.
#pragma once

#include <array>
#include <cstddef>

#include "physics/dynamics/articulated_body.hpp"
#include "physics/dynamics/bullet.hpp"
#include "physics/dynamics/surface.hpp"

namespace kenaf::physics {

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

// A motion of a body, or an impulse on it with its moment, about the body's C. Along in lane 0, across in lane 1.
struct InPatch {
  Two linear, angular;
  btScalar linear_n, angular_n;
};
inline InPatch operator+(const InPatch& a, const InPatch& b) {
  return {a.linear + b.linear, a.angular + b.angular, a.linear_n + b.linear_n, a.angular_n + b.angular_n};
}
inline InPatch operator-(const InPatch& a, const InPatch& b) {
  return {a.linear - b.linear, a.angular - b.angular, a.linear_n - b.linear_n, a.angular_n - b.angular_n};
}
inline InPatch operator*(const InPatch& a, btScalar s) {
  return {a.linear * s, a.angular * s, a.linear_n * s, a.angular_n * s};
}
inline btScalar dot(const InPatch& a, const InPatch& b) {
  return sum_of_lanes(a.linear * b.linear + a.angular * b.angular) + a.linear_n * b.linear_n +
         a.angular_n * b.angular_n;
}

// A point of a patch, from a body's C: r = (r_along, r_across, r_normal).
struct PlaceInPatch {
  Two turned{};         // (-r_across, r_along)
  btScalar height = 0;  // r_normal
};
inline PlaceInPatch place_at(const btVector3& r) {
  return {Two{-r.y(), r.x()}, r.z()};
}

// linear + angular x r, in its three components.
inline Two tangential_velocity(const InPatch& motion, const PlaceInPatch& r) {
  return motion.linear + Two{motion.angular[1], -motion.angular[0]} * r.height + motion.angular_n * r.turned;
}
inline btScalar normal_velocity(const InPatch& motion, const PlaceInPatch& r) {
  return motion.linear_n - sum_of_lanes(motion.angular * r.turned);
}
// With the moment r x impulse.
inline InPatch impulse_at(const PlaceInPatch& r, btScalar normal, Two friction) {
  return {friction, r.height * Two{-friction[1], friction[0]} - normal * r.turned, normal,
          sum_of_lanes(r.turned * friction)};
}

// The change of velocities along a patch's axes by unit impulses at a place of it: J M^-1 J^T.
struct MobilityAtPlace {
  btScalar normal, along_by_across;
  Two tangents, tangents_by_normal;

  void operator+=(const MobilityAtPlace& b) {
    normal += b.normal;
    along_by_across += b.along_by_across;
    tangents += b.tangents;
    tangents_by_normal += b.tangents_by_normal;
  }
};

// One of a patch's bodies, in its axes.
//
// Contacts on an arm see the base's motion and, where the arm's servo yields, the arm's own. With the base's response
// R, the arm's coupling c and mobility g (articulated_body.hpp), u the motion of a unit rate of the arm, d = R c, and
// an impulse p on the arm, this motion changes by
//   R p + g (1 + g c . d) u (u . p) - g (d (u . p) + u (d . p))
struct BodyInPatch {
  ContactSide moves;
  Belt* belt = nullptr;
  btScalar arm_mobility = 0;  // g; 0: no arm, or its servo holds
  Two gain{};                 // slip for a unit belt speed, and push on the belt for a unit impulse; 0 without a belt

  // Of a body that moves. The inverse inertia about C with stiff hinges, by its columns.
  btVector3 p_WC;
  Two turn_by_along, turn_by_across, turn_by_normal;
  btScalar turn_n_by_n, inverse_mass;
  InPatch free_motion;                              // without contacts; of the arm, if it is on one
  InPatch unit_rate, response;                      // u of the arm, d; of an arm that holds only u is set
  std::array<InPatch, robot::kFlipperCount> loose;  // ArticulatedBody::loose
  std::size_t loose_count = 0;
  btScalar arm_alone;  // g (1 + g c . d)

  // What its contacts see, by an impulse on it.
  InPatch change_by(const InPatch& impulse) const;
  MobilityAtPlace mobility_at(const PlaceInPatch& r) const;
  // To those of stiff hinges.
  void add_yielding(InPatch& change, const InPatch& impulse) const;
  void add_yielding(MobilityAtPlace& m, const PlaceInPatch& r) const;
};

inline InPatch BodyInPatch::change_by(const InPatch& impulse) const {
  const Two& turn = impulse.angular;
  InPatch change{impulse.linear * inverse_mass,
                 turn_by_along * turn[0] + turn_by_across * turn[1] + turn_by_normal * impulse.angular_n,
                 impulse.linear_n * inverse_mass,
                 sum_of_lanes(turn_by_normal * turn) + turn_n_by_n * impulse.angular_n};
  if (loose_count > 0) add_yielding(change, impulse);
  return change;
}

// With t = (-r_across, r_along), h = r_normal and the inverse inertia Q, the moments of unit impulses are
//   along (0, h, t_0)      across (-h, 0, t_1)      normal (-t_0, -t_1, 0)
inline MobilityAtPlace BodyInPatch::mobility_at(const PlaceInPatch& r) const {
  const Two t = r.turned;
  const btScalar h = r.height;
  const Two turned = turn_by_along * t[0] + turn_by_across * t[1];
  const btScalar turned_n = sum_of_lanes(turn_by_normal * t);
  MobilityAtPlace m;
  m.normal = inverse_mass + sum_of_lanes(t * turned);
  m.tangents_by_normal = h * Two{-turned[1], turned[0]} - t * turned_n;
  const Two across_along{turn_by_normal[1], -turn_by_normal[0]};
  m.tangents =
      inverse_mass + h * (h * Two{turn_by_across[1], turn_by_along[0]} + 2 * t * across_along) + t * t * turn_n_by_n;
  m.along_by_across =
      h * (t[1] * turn_by_normal[1] - t[0] * turn_by_normal[0] - h * turn_by_along[1]) + t[0] * t[1] * turn_n_by_n;
  if (loose_count > 0) add_yielding(m, r);
  return m;
}

struct ContactPatch {
  // With the bodies as take_bodies() finds them.
  ContactPatch(const Meeting& meeting, const btVector3& normal_W, bool holds_lugs);

  // Reads again what depends on which servos and motors hold.
  void take_bodies();
  bool on_ground() const { return !b.moves.body && !b.belt; }
  bool on_one_body() const { return a.moves.body == b.moves.body; }
  // Whether friction on it moves A's base and nothing else: a belt or an arm that yields would take a part.
  bool moves_base_alone() const {
    return on_ground() && a.arm_mobility == 0 && (!a.belt || a.belt->mobility_per_kg == 0);
  }

  InPatch in_patch(const TwoVectors& in_W) const;
  TwoVectors in_W(const InPatch& in_patch) const;
  btVector3 in_patch(const btVector3& v_W) const { return {along_W.dot(v_W), across_W.dot(v_W), normal_W.dot(v_W)}; }
  btVector3 in_W(btScalar normal, Two tangents) const {
    return normal_W * normal + along_W * tangents[0] + across_W * tangents[1];
  }
  // The motion by contacts of this step that contacts on a body see, which is not fixed.
  InPatch seen(const BodyInPatch& body) const;
  // Impulses on a body of the patch that is not fixed, in sum.
  void give(const BodyInPatch& body, const InPatch& impulse) const;
  MobilityAtPlace mobility_at(const PlaceInPatch& from_a, const PlaceInPatch& from_b) const;
  MobilityAtPlace mobility_between_arms(const PlaceInPatch& from_a, const PlaceInPatch& from_b) const;

  const Collider *collider_a, *collider_b;
  TouchingPart part_a, part_b;  // of the robots that these belong to
  btVector3 along_W, across_W, normal_W;
  BodyInPatch a, b;
  Two mu, inverse_mu;
  btScalar compliance_scale, damping_scale;  // of both surfaces
  btScalar fading;                           // the share of a friction that sticks which is left for the next step
  bool holds_lugs;
  std::size_t contact_count = 0;  // that follow each other in the solver's list
  InPatch given_a, given_b;       // by the contacts' changes of one iteration
};

inline MobilityAtPlace ContactPatch::mobility_at(const PlaceInPatch& from_a, const PlaceInPatch& from_b) const {
  MobilityAtPlace m = on_one_body() ? mobility_between_arms(from_a, from_b) : a.mobility_at(from_a);
  if (b.moves.body && !on_one_body()) m += b.mobility_at(from_b);
  // Belts that their motors do not hold: gain gain^T times the mobility.
  for (const BodyInPatch* of : {&a, &b}) {
    if (!of->belt) continue;
    m.tangents += of->gain * of->gain * of->belt->mobility_per_kg;
    m.along_by_across += of->gain[0] * of->gain[1] * of->belt->mobility_per_kg;
  }
  return m;
}

}  // namespace kenaf::physics
