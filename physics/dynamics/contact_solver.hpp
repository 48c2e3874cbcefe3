// Sequential impulses over the contacts of bodies whose hinges are eliminated (articulated_body.hpp): belts that run
// over surfaces, friction that does not depend on axes, and slightly compliant ground. docs/physics.md has the
// equations and why they are so.
#pragma once

#include <span>
#include <vector>

#include "physics/dynamics/articulated_body.hpp"
#include "physics/dynamics/belt_ground.hpp"
#include "physics/dynamics/body_groups.hpp"
#include "physics/dynamics/bullet.hpp"
#include "physics/dynamics/contact.hpp"
#include "physics/dynamics/contact_patch.hpp"
#include "physics/dynamics/friction_creep.hpp"
#include "physics/dynamics/surface.hpp"

namespace kenaf::physics {

class ContactSolver {
 public:
  ContactSolver(const ContactSettings& settings, BeltGround& belt_ground)
      : settings_(settings), belt_ground_(belt_ground) {
    contacts_.reserve(kManyContacts);  // without a robot: of boxes
  }

  // `body`: the one that carries the belt, or one that is joined to it.
  void add_belt(Belt* belt, const btRigidBody* body);
  void remove_belt(Belt* belt);
  // Removes the contacts of an object that leaves its place or the world from contacts().
  void forget_contacts_of(const btCollisionObject& object);
  // Solves one step's impulses and writes them back as velocities. Each of `joints` is a FlipperJoint, from a base to
  // an arm that has no other joint. Groups of bodies are solved independently; each stops when nothing changes in it
  // any more.
  void solve(btAlignedObjectArray<btRigidBody*>& bodies, btDispatcher& dispatcher,
             btAlignedObjectArray<btTypedConstraint*>& joints, const btContactSolverInfo& info);
  // The contacts of the last step, and their patches.
  std::span<const Contact> contacts() const { return contacts_; }
  std::span<const ContactPatch> patches() const { return patches_; }

 private:
  // Room for one side of a robot, so that a step need not allocate: contacts, and pairs of a belt and an object near
  // it. In a field of posts of 100 mm an inclined belt of Kenaf's is near 50 of them.
  static constexpr std::size_t kManyContacts = 128;
  static constexpr std::size_t kManyPairs = 96;

  struct BeltOfBody {
    Belt* belt;
    const btRigidBody* body;
  };

  // Fills bodies_, arms_ and sides_.
  void assemble(btAlignedObjectArray<btRigidBody*>& bodies, const btAlignedObjectArray<btTypedConstraint*>& joints,
                const btContactSolverInfo& info);
  ContactSide side_of(const btCollisionObject& object) const;
  std::size_t group_of(const btCollisionObject& moving) const;
  // Fills groups_ and the lists of bodies, belts and touching pairs by group.
  void find_groups(btDispatcher& dispatcher);
  void make_contacts(btDispatcher& dispatcher, btScalar time_step);
  void solve_group(std::size_t group, const btContactSolverInfo& info);
  btScalar solve_friction_of_belts(std::size_t group);
  enum class Iteration { shared, one_by_one };
  btScalar iterate(std::size_t group, Iteration how);  // returns the largest squared velocity change
  bool settle_motors(std::size_t group);               // of belts, and servos
  // Bodies, belts and contacts of the group for motors at other limits, with the contacts' impulses as they are.
  void make_anew(std::size_t group);
  void let_friction_creep();  // friction_creep.hpp, by all contacts
  std::span<ContactPatch> patches_of(std::size_t group);
  std::span<Contact> contacts_of(std::size_t group);
  void add_manifold(btPersistentManifold& manifold, btScalar time_step);
  void add_belt_pair(BeltPair& pair, btScalar time_step);
  // Into the last patch, if that is of the same meeting and has the same normal, or into one of its own.
  void add_contact(const Meeting& meeting, bool same_meeting, const Touch& touch, btScalar time_step);

  ContactSettings settings_;
  BeltGround& belt_ground_;
  std::vector<BeltOfBody> belts_;
  std::vector<ArticulatedBody> bodies_;
  std::vector<Arm> arms_;           // body by body
  PlacesByGroup joints_by_base_;    // indices into Bullet's list of joints
  std::vector<ContactSide> sides_;  // of each of Bullet's bodies
  BodyGroups groups_;               // of bodies_
  // Indices into bodies_, into belts_, and into touching_.
  PlacesByGroup bodies_by_group_, belts_by_group_, touching_by_group_;
  std::vector<std::size_t>
      touching_;  // number of a manifold that has contacts, or of a belt pair, counted on after the manifolds
  // Group by group; contacts patch by patch.
  std::vector<ContactPatch> patches_;
  std::vector<Contact> contacts_;
  std::vector<std::size_t> patches_end_, contacts_end_;  // of each group
  std::vector<FrictionCreep> creeps_;                    // of each of bodies_
  std::vector<TwoVectors> given_back_;
  bool some_shear_ = false;  // of contacts_
};

}  // namespace kenaf::physics
