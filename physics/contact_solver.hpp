// Bullet's sequential impulse solver with contacts of our own: belts that run over surfaces, friction that does not
// depend on axes, and a little give of the ground. docs/physics.md has the equations and why they are so.
#pragma once

#include <span>
#include <vector>

#include "physics/belt_ground.hpp"
#include "physics/bullet.hpp"
#include "physics/surface.hpp"

namespace kenaf::physics {

class FlipperJoint;

struct ContactSettings {
  double stiffness_npm;  // of one contact point
  double damping_nspm;
};

class ContactSolver : public btSequentialImpulseConstraintSolver {
 public:
  // One contact point. Everything is of body A relative to body B, and A is never fixed. Rows: normal (from B to A),
  // along, across.
  struct Contact {
    btScalar* kept[3];  // where the impulses stay until the next step
    const Collider *collider_a, *collider_b;
    btVector3 p_W;
    int body_a, body_b;  // in the solver's pool
    bool b_moves;
    btVector3 axis[3];
    btVector3 push_a[3];             // inverse mass * axis
    btVector3 arm_a[3], arm_b[3];    // r x axis
    btVector3 turn_a[3], turn_b[3];  // inverse inertia * arm
    btScalar inverse_mass_a, inverse_mass_b;
    Belt *belt_a, *belt_b;
    btScalar belt_gain_a[2], belt_gain_b[2];  // slip along, across for a belt's speed; 0 without a belt
    btScalar belt_push_a[2], belt_push_b[2];  // belt's speed for a unit impulse along, across
    btScalar free_velocity[3];                // before any impulse of this step
    btScalar normal_mass, softness, give_velocity;
    btScalar normal_to_slip[2];  // slip along, across for a unit normal impulse
    btScalar stick[3];           // inverse of the 2 x 2 matrix from friction impulse to slip: 11, 12, 22
    btScalar slide_step;
    btScalar mu[2], inverse_mu[2];
    btScalar impulse[3];
  };

  ContactSolver(const ContactSettings& settings, BeltGround& belt_ground)
      : settings_(settings), belt_ground_(belt_ground) {
    contacts_.reserve(kManyContacts);  // without a robot: of boxes
  }

  void add_belt(Belt* belt) {
    belts_.push_back(belt);
    contacts_.reserve(kManyContacts * belts_.size());
    belt_ground_.make_room(kManyPairs * belts_.size());
  }
  void remove_belt(Belt* belt) { std::erase(belts_, belt); }
  // For what leaves the world: contacts() no longer speaks of it.
  void forget_contacts_of(const btCollisionObject& object);
  btScalar solveGroup(btCollisionObject** bodies, int body_count, btPersistentManifold** manifolds, int manifold_count,
                      btTypedConstraint** constraints, int constraint_count, const btContactSolverInfo& info,
                      btIDebugDraw* debug, btDispatcher* dispatcher) override;
  // Of the last step.
  std::span<const Contact> contacts() const { return contacts_; }

 protected:
  btScalar solveGroupCacheFriendlySetup(btCollisionObject** bodies, int body_count, btPersistentManifold** manifolds,
                                        int manifold_count, btTypedConstraint** constraints, int constraint_count,
                                        const btContactSolverInfo& info, btIDebugDraw* debug) override;
  void convertContacts(btPersistentManifold** manifolds, int count, const btContactSolverInfo& info) override;
  btScalar solveSingleIteration(int iteration, btCollisionObject** bodies, int body_count,
                                btPersistentManifold** manifolds, int manifold_count, btTypedConstraint** constraints,
                                int constraint_count, const btContactSolverInfo& info, btIDebugDraw* debug) override;
  btScalar solveGroupCacheFriendlyFinish(btCollisionObject** bodies, int body_count,
                                         const btContactSolverInfo& info) override;

 private:
  // Of one side of a robot, so that a step need not allocate. In a field of pallets each of its three belts is near ten or more.
  static constexpr std::size_t kManyContacts = 128, kManyPairs = 48;

  // What a contact is made of, however it was found.
  struct Touch {
    btVector3 p_W, normal_W;  // from B to A
    btScalar gap_m, share;
    bool edge;
    const Surface &surface_a, &surface_b;
    btScalar* kept[3];
  };
  void add_manifold(btPersistentManifold& manifold, btScalar time_step);
  void add_belt_pair(BeltPair& pair, btScalar time_step);
  void add_contact(const Touch& touch, const btCollisionObject& a, const btCollisionObject& b, int body_a, int body_b,
                   btScalar time_step);
  void warm_start(Contact& contact);
  btScalar solve_contact(Contact& contact);  // gives the square of the velocity by which it changed body A
  static btScalar solve_running_gear(Belt& belt, btScalar time_step);  // gives the largest square of a speed change
  void apply(Contact& contact, const btScalar change[3]);

  ContactSettings settings_;
  BeltGround& belt_ground_;
  std::vector<Contact> contacts_;
  std::vector<Belt*> belts_;
};

}  // namespace kenaf::physics
