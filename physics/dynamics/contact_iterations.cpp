#include "physics/dynamics/contact_iterations.hpp"

#include <algorithm>

namespace kenaf::physics {
namespace {

void add(InPatch& sum, const PlaceInPatch& r, const Contact::Change& change) {
  sum = sum + impulse_at(r, change.normal, change.friction);
}

void push_belt(const BodyInPatch& of, const InPatch& on_a) {
  if (!of.belt) return;
  of.belt->push_ns += sum_of_lanes(of.gain * on_a.linear);
  of.belt->load_ns += on_a.linear_n;
}

// Impulses on A, about the bodies' C; B has the opposite. Both belts' gains count those on A.
void give(const ContactPatch& patch, const InPatch& about_a, const InPatch& about_b) {
  patch.give(patch.a, about_a);
  push_belt(patch.a, about_a);
  if (patch.on_ground()) return;
  if (patch.b.moves.body) patch.give(patch.b, InPatch{} - about_b);
  push_belt(patch.b, about_b);
}

Two slip_by_belts(const ContactPatch& patch) {
  Two slip{0, 0};
  if (patch.a.belt) slip += patch.a.gain * (patch.a.belt->mobility_per_kg * patch.a.belt->push_ns);
  if (patch.b.belt) slip += patch.b.gain * (patch.b.belt->mobility_per_kg * patch.b.belt->push_ns);
  return slip;
}

Contact::Seen seen_at(const Contact& contact, const InPatch& a, const InPatch& b, Two by_belts) {
  return {normal_velocity(a, contact.from_a()) - normal_velocity(b, contact.from_b()),
          tangential_velocity(a, contact.from_a()) - tangential_velocity(b, contact.from_b()) + by_belts};
}
Contact::Seen seen_at(const Contact& contact, const InPatch& a, Two by_belts) {
  return {normal_velocity(a, contact.from_a()), tangential_velocity(a, contact.from_a()) + by_belts};
}

// The squared velocity change of a body of this mass.
btScalar residual_of(const Contact::Change& change, btScalar inverse_mass) {
  const Two squares = change.friction * change.friction;
  return (change.normal * change.normal + squares[0] + squares[1]) * inverse_mass * inverse_mass;
}

template <bool kSomeShear>
btScalar share_each(std::span<ContactPatch> patches, std::span<Contact> contacts) {
  btScalar residual = 0;
  for_each_patch(patches, contacts, [&](ContactPatch& patch, std::span<Contact> of_patch) {
    const bool on_ground = patch.on_ground();
    const InPatch a = patch.seen(patch.a), b = patch.b.moves.body ? patch.seen(patch.b) : InPatch{};
    const Two by_belts = slip_by_belts(patch);
    const int sharing =
        std::max({patch.a.moves.body->contact_count, patch.b.moves.body ? patch.b.moves.body->contact_count : 0, 1});
    const btScalar share = 1.0 / sharing;
    InPatch given_a{}, given_b{};
    btScalar largest = 0;
    for (Contact& contact : of_patch) {
      const Contact::Seen seen = on_ground ? seen_at(contact, a, by_belts) : seen_at(contact, a, b, by_belts);
      const Contact::Change change = contact.wanted_change<kSomeShear>(seen, share);
      contact.make(change);
      add(given_a, contact.from_a(), change);
      if (!on_ground) add(given_b, contact.from_b(), change);
      largest = std::max(largest, residual_of(change, patch.a.inverse_mass));
    }
    residual = std::max(residual, largest * sharing * sharing);
    patch.given_a = given_a;
    patch.given_b = given_b;
  });
  for (const ContactPatch& patch : patches) give(patch, patch.given_a, patch.given_b);
  return residual;
}

template <bool kSomeShear>
btScalar solve_on_ground(ContactPatch& patch, std::span<Contact> contacts) {
  InPatch motion = patch.seen(patch.a), given{};
  Two by_belts = slip_by_belts(patch);
  const btScalar belt_mobility = patch.a.belt ? patch.a.belt->mobility_per_kg : 0;
  btScalar largest = 0;
  for (Contact& contact : contacts) {
    const Contact::Change change = contact.wanted_change<kSomeShear>(seen_at(contact, motion, by_belts), 1);
    contact.make(change);
    const InPatch impulse = impulse_at(contact.from_a(), change.normal, change.friction);
    motion = motion + patch.a.change_by(impulse);
    by_belts += patch.a.gain * (belt_mobility * sum_of_lanes(patch.a.gain * change.friction));
    given = given + impulse;
    largest = std::max(largest, residual_of(change, patch.a.inverse_mass));
  }
  give(patch, given, InPatch{});
  return largest;
}

// What moves may be on both sides of a contact, an arm of the same robot or a belt: read and given in place.
template <bool kSomeShear>
btScalar solve_between_moving(ContactPatch& patch, std::span<Contact> contacts) {
  btScalar largest = 0;
  for (Contact& contact : contacts) {
    const InPatch a = patch.seen(patch.a), b = patch.b.moves.body ? patch.seen(patch.b) : InPatch{};
    const Contact::Change change = contact.wanted_change<kSomeShear>(seen_at(contact, a, b, slip_by_belts(patch)), 1);
    contact.make(change);
    give(patch, impulse_at(contact.from_a(), change.normal, change.friction),
         impulse_at(contact.from_b(), change.normal, change.friction));
    largest = std::max(largest, residual_of(change, patch.a.inverse_mass));
  }
  return largest;
}

template <bool kSomeShear>
btScalar solve_each(std::span<ContactPatch> patches, std::span<Contact> contacts) {
  btScalar residual = 0;
  for_each_patch(patches, contacts, [&](ContactPatch& patch, std::span<Contact> of_patch) {
    residual = std::max(residual, patch.on_ground() ? solve_on_ground<kSomeShear>(patch, of_patch)
                                                    : solve_between_moving<kSomeShear>(patch, of_patch));
  });
  return residual;
}

}  // namespace

void warm_start(std::span<ContactPatch> patches, std::span<Contact> contacts) {
  for_each_patch(patches, contacts, [&](ContactPatch& patch, std::span<Contact> of_patch) {
    InPatch about_a{}, about_b{};
    for (const Contact& contact : of_patch) {
      about_a = about_a + impulse_at(contact.from_a(), contact.normal_impulse(), contact.friction_impulse());
      about_b = about_b + impulse_at(contact.from_b(), contact.normal_impulse(), contact.friction_impulse());
    }
    give(patch, about_a, about_b);
  });
}

btScalar share_evenly(std::span<ContactPatch> patches, std::span<Contact> contacts, bool some_shear) {
  return some_shear ? share_each<true>(patches, contacts) : share_each<false>(patches, contacts);
}

btScalar solve_in_turn(std::span<ContactPatch> patches, std::span<Contact> contacts, bool some_shear) {
  return some_shear ? solve_each<true>(patches, contacts) : solve_each<false>(patches, contacts);
}

}  // namespace kenaf::physics
