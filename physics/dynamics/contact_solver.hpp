// A sequential impulse solver like Bullet's, with our own contacts: belts that run over surfaces, friction that does
// not depend on axes, and slightly compliant ground. docs/physics.md has the equations and why they are so.
#pragma once

#include <span>
#include <vector>

#include "physics/dynamics/belt_ground.hpp"
#include "physics/dynamics/body_groups.hpp"
#include "physics/dynamics/bullet.hpp"
#include "physics/dynamics/contact.hpp"
#include "physics/dynamics/joint_rows.hpp"
#include "physics/dynamics/solver_body.hpp"
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
  // Solves one step's impulses and writes them back as velocities. Each of `joints` is a FlipperJoint. Groups of bodies
  // are solved independently; each stops when nothing changes in it any more.
  void solve(btAlignedObjectArray<btRigidBody*>& bodies, btDispatcher& dispatcher,
             btAlignedObjectArray<btTypedConstraint*>& joints, const btContactSolverInfo& info);
  // The contacts of the last step.
  std::span<const Contact> contacts() const { return contacts_; }

 private:
  // Room for one side of a robot, so that a step need not allocate: contacts, and pairs of a belt and an object near
  // it. In a field of posts of 100 mm an inclined belt of Kenaf's is near 50 of them.
  static constexpr std::size_t kManyContacts = 128;
  static constexpr std::size_t kManyPairs = 96;

  struct BeltOfBody {
    Belt* belt;
    const btRigidBody* body;
  };

  SolverBody* solver_body(const btCollisionObject& object);  // null if it is fixed
  std::size_t group_of(const btCollisionObject& moving) const;
  // Fills groups_ and the lists of joints, belts and touching pairs by group.
  void find_groups(btDispatcher& dispatcher, const btAlignedObjectArray<btTypedConstraint*>& joints);
  void make_joints(const btAlignedObjectArray<btTypedConstraint*>& joints, const btContactSolverInfo& info);
  void make_contacts(btDispatcher& dispatcher, btScalar time_step);
  void start_belts();
  btScalar iterate(std::size_t group, btScalar time_step);  // returns the largest squared velocity change
  void add_manifold(btPersistentManifold& manifold, btScalar time_step);
  void add_belt_pair(BeltPair& pair, btScalar time_step);
  static btScalar solve_running_gear(Belt& belt, btScalar time_step);  // returns the largest squared speed change

  ContactSettings settings_;
  BeltGround& belt_ground_;
  std::vector<SolverBody> bodies_;
  std::vector<BeltOfBody> belts_;
  BodyGroups groups_;
  // Indices into Bullet's list of joints, into belts_, and into touching_.
  PlacesByGroup joints_by_group_, belts_by_group_, touching_by_group_;
  std::vector<std::size_t>
      touching_;  // number of a manifold that has contacts, or of a belt pair, counted on after the manifolds
  // Group by group.
  std::vector<JointRows> joints_;
  std::vector<Contact> contacts_;
  bool some_shear_ = false;                // of contacts_
  std::vector<std::size_t> contacts_end_;  // of each group
};

}  // namespace kenaf::physics
