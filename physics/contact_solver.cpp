#include "physics/contact_solver.hpp"

#include <algorithm>
#include <cmath>

namespace kenaf::physics {
namespace {

// Tracks that once pulled against each other must not do so for ever: a belt that rolls brings unloaded rubber into
// contact, and rubber creeps. After this way or time, 1/e of an old friction impulse is left to start from.
constexpr double kRenewal_m = 0.02;
constexpr double kCreep_s = 0.5;

const Surface& surface_of(const btCollisionObject& body, int child) {
  const auto& collider = *static_cast<const Collider*>(body.getUserPointer());
  const auto i = static_cast<std::size_t>(child);
  return collider.surfaces[i < collider.surfaces.size() ? i : 0];
}

}  // namespace

void ContactSolver::forget_contacts_of(const btCollisionObject& object) {
  const void* collider = object.getUserPointer();
  std::erase_if(contacts_,
                [collider](const Contact& c) { return &c.collider_a() == collider || &c.collider_b() == collider; });
}

void ContactSolver::solve(btAlignedObjectArray<btRigidBody*>& bodies, btDispatcher& dispatcher,
                          btAlignedObjectArray<btTypedConstraint*>& joints, const btContactSolverInfo& info) {
  bodies_.resize(static_cast<std::size_t>(bodies.size()));
  for (int i = 0; i < bodies.size(); ++i) {
    bodies_[static_cast<std::size_t>(i)] = to_solver(*bodies[i], info.m_timeStep);
    bodies[i]->setCompanionId(i);
  }
  joints_.clear();
  for (int i = 0; i < joints.size(); ++i)
    joints_.emplace_back(static_cast<FlipperJoint&>(*joints[i]), *solver_body(joints[i]->getRigidBodyA()),
                         *solver_body(joints[i]->getRigidBodyB()), info);
  make_contacts(dispatcher, info.m_timeStep);
  start_belts();
  for (Contact& contact : contacts_) contact.warm_start();
  for (JointRows& joint : joints_) joint.warm_start();
  for (int i = 0; i < info.m_numIterations; ++i)
    if (iterate(info.m_timeStep) <= info.m_leastSquaresResidualThreshold) break;
  for (Contact& contact : contacts_) contact.finish();
  for (JointRows& joint : joints_) joint.finish();
  for (const SolverBody& body : bodies_) write_back(body);
}

SolverBody* ContactSolver::solver_body(const btCollisionObject& object) {
  return object.isStaticOrKinematicObject() ? nullptr : &bodies_[static_cast<std::size_t>(object.getCompanionId())];
}

void ContactSolver::make_contacts(btDispatcher& dispatcher, btScalar time_step) {
  contacts_.clear();
  for (Belt* belt : belts_) belt->kept = std::exp(-time_step * (std::abs(belt->speed_mps) / kRenewal_m + 1 / kCreep_s));
  for (int m = 0; m < dispatcher.getNumManifolds(); ++m)
    add_manifold(*dispatcher.getManifoldByIndexInternal(m), time_step);
  for (BeltPair* pair : belt_ground_.pairs()) add_belt_pair(*pair, time_step);
}

void ContactSolver::start_belts() {
  for (Belt* belt : belts_) {
    belt->motor_impulse_ns =
        std::clamp(belt->kept * belt->motor_impulse_ns, belt->min_impulse_ns, belt->max_impulse_ns);
    belt->friction_impulse_ns *= belt->kept;
    belt->viscous_impulse_ns *= belt->kept;
    belt->speed_mps +=
        (belt->motor_impulse_ns + belt->friction_impulse_ns + belt->viscous_impulse_ns) / belt->moving_mass_kg;
    belt->load_ns = 0;
  }
}

btScalar ContactSolver::iterate(btScalar time_step) {
  btScalar residual = 0;
  for (JointRows& joint : joints_) residual = btMax(residual, joint.solve());
  for (Belt* belt : belts_) residual = std::max(residual, solve_running_gear(*belt, time_step));
  return std::max(residual, Contact::solve(contacts_));
}

void ContactSolver::add_manifold(btPersistentManifold& manifold, btScalar time_step) {
  const btCollisionObject *body0 = manifold.getBody0(), *body1 = manifold.getBody1();
  SolverBody *solver0 = solver_body(*body0), *solver1 = solver_body(*body1);
  if (manifold.getNumContacts() == 0 || (!solver0 && !solver1)) return;
  for (int i = 0; i < manifold.getNumContacts(); ++i) {
    btManifoldPoint& point = manifold.getContactPoint(i);
    const Surface& surface0 = surface_of(*body0, point.m_index0);
    const Surface& surface1 = surface_of(*body1, point.m_index1);
    // one point for both bodies, so that the two impulses cancel in moment too
    const btVector3 p_W = (point.getPositionWorldOnA() + point.getPositionWorldOnB()) * 0.5;
    // Bullet keeps these numbers with a point that it finds again, and no directions: they are along this contact's
    // own axes
    const Touch touch{p_W,
                      solver0 ? point.m_normalWorldOnB : -point.m_normalWorldOnB,
                      point.getDistance(),
                      1,
                      false,
                      {&point.m_appliedImpulse, &point.m_appliedImpulseLateral1, &point.m_appliedImpulseLateral2}};
    const Meeting meeting = solver0 ? Meeting(*body0, *body1, solver0, solver1, surface0, surface1)
                                    : Meeting(*body1, *body0, solver1, nullptr, surface1, surface0);
    contacts_.emplace_back(meeting, touch, settings_, time_step);
  }
}

void ContactSolver::add_belt_pair(BeltPair& pair, btScalar time_step) {
  if (pair.contacts.empty()) return;
  const Meeting meeting(*pair.body, *pair.ground, solver_body(*pair.body), solver_body(*pair.ground),
                        pair.belt->surface, surface_of(*pair.ground, 0));
  for (BeltContact& contact : pair.contacts) {
    const BeltTouch& at = contact.touch;
    const Touch touch{pair.X_WT * at.p_T,
                      pair.X_WT.getBasis() * at.normal_T,
                      at.gap_m,
                      at.share,
                      at.holds_lugs,
                      {&contact.impulse[0], &contact.impulse[1], &contact.impulse[2]}};
    contacts_.emplace_back(meeting, touch, settings_, time_step);
  }
}

btScalar ContactSolver::solve_running_gear(Belt& belt, btScalar time_step) {
  if (std::isinf(belt.moving_mass_kg)) return 0;
  btScalar changed = 0;
  const auto push = [&](double& impulse_ns, double wanted_ns, double min_ns, double max_ns) {
    const double before = impulse_ns;
    impulse_ns = std::clamp(wanted_ns, min_ns, max_ns);
    const double change_mps = (impulse_ns - before) / belt.moving_mass_kg;
    belt.speed_mps += change_mps;
    changed = std::max(changed, change_mps * change_mps);
  };
  const double m = belt.moving_mass_kg;
  push(belt.motor_impulse_ns, belt.motor_impulse_ns + (belt.target_mps - belt.speed_mps) * m, belt.min_impulse_ns,
       belt.max_impulse_ns);
  if (const double damping_ns = belt.viscous_nspm * time_step; damping_ns > 0) {
    // impulse = -damping * speed, with the speed after it
    const double free_mps = belt.speed_mps - belt.viscous_impulse_ns / m;
    push(belt.viscous_impulse_ns, -free_mps / (1 / damping_ns + 1 / m), -1e9, 1e9);
  }
  // without a load too: what rolling friction gave in the last step has to go. A sum of changes may end below 0
  if (const double dry_ns = belt.dry_friction_ns + belt.rolling_resistance * std::max(belt.load_ns, 0.0);
      dry_ns > 0 || belt.friction_impulse_ns != 0)
    push(belt.friction_impulse_ns, belt.friction_impulse_ns - belt.speed_mps * m, -dry_ns, dry_ns);
  return changed;
}

}  // namespace kenaf::physics
