// How the contacts of a group of bodies are solved together: each calls for a change by itself (contact.hpp), and an
// iteration makes the changes of all of them, at once or one after the other.
//
// `contacts` are those of `patches`, patch by patch. Thread safety: a group by one thread.
#pragma once

#include <span>

#include "physics/dynamics/contact.hpp"
#include "physics/dynamics/contact_patch.hpp"

namespace kenaf::physics {

// use(patch, its contacts) for each patch; both const, or neither.
template <typename Patch, typename PatchContact, typename Use>
void for_each_patch(std::span<Patch> patches, std::span<PatchContact> contacts, const Use& use) {
  for (Patch& patch : patches) {
    use(patch, contacts.first(patch.contact_count));
    contacts = contacts.subspan(patch.contact_count);
  }
}

// Gives the bodies and belts the impulses that the contacts start from.
void warm_start(std::span<ContactPatch> patches, std::span<Contact> contacts);

// An iteration in which each contact moves an equal share of its body's mass, all by the same velocities (mass
// splitting: Tonge, Benevolenski, Voroshilov, "Mass splitting for jitter-free parallel rigid body simulation", 2012).
// What several could hold is shared evenly, whatever their order. Returns the largest squared velocity change of a
// body A that a contact would make alone. `some_shear`: a contact may have a stretch.
btScalar share_evenly(std::span<ContactPatch> patches, std::span<Contact> contacts, bool some_shear);

// An iteration over contacts in their order, each with what those before it have left. Returns the largest squared
// velocity change of a body A.
btScalar solve_in_turn(std::span<ContactPatch> patches, std::span<Contact> contacts, bool some_shear);

}  // namespace kenaf::physics
