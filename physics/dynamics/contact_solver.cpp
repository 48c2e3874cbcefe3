#include "physics/dynamics/contact_solver.hpp"

#include <algorithm>
#include <cmath>

namespace kenaf::physics {
namespace {

// Tracks that once pulled against each other must not do so for ever: a belt that rolls brings unloaded rubber into
// contact, and rubber creeps. After this distance or time, 1/e of an old friction impulse is left to start from.
constexpr double kRenewal_m = 0.02;
constexpr double kCreep_s = 0.5;

const Surface& surface_of(const btCollisionObject& body, int child) {
  const auto& collider = *static_cast<const Collider*>(body.getUserPointer());
  const auto i = static_cast<std::size_t>(child);
  return collider.surfaces[i < collider.surfaces.size() ? i : 0];
}

}  // namespace

void ContactSolver::add_belt(Belt* belt, const btRigidBody* body) {
  belts_.push_back({belt, body});
  contacts_.reserve(kManyContacts * belts_.size());
  touching_.reserve(kManyContacts * belts_.size());
  touching_by_group_.make_room(kManyContacts * belts_.size());
  belt_ground_.make_room(kManyPairs * belts_.size());
}

void ContactSolver::remove_belt(Belt* belt) {
  std::erase_if(belts_, [belt](const BeltOfBody& of) { return of.belt == belt; });
}

void ContactSolver::forget_contacts_of(const btCollisionObject& object) {
  const void* collider = object.getUserPointer();
  std::erase_if(contacts_,
                [collider](const Contact& c) { return &c.collider_a() == collider || &c.collider_b() == collider; });
}

void ContactSolver::solve(btAlignedObjectArray<btRigidBody*>& bodies, btDispatcher& dispatcher,
                          btAlignedObjectArray<btTypedConstraint*>& joints, const btContactSolverInfo& info) {
  // Bodies, groups and rows; a row's impulse starts from the last step's.
  bodies_.resize(static_cast<std::size_t>(bodies.size()));
  for (int i = 0; i < bodies.size(); ++i) {
    bodies_[static_cast<std::size_t>(i)] = to_solver(*bodies[i], info.m_timeStep);
    bodies[i]->setCompanionId(i);
  }
  find_groups(dispatcher, joints);
  make_joints(joints, info);
  make_contacts(dispatcher, info.m_timeStep);
  start_belts();
  for (Contact& contact : contacts_) contact.warm_start();
  for (JointRows& joint : joints_) joint.warm_start();

  // Each group by itself, until an iteration changes no velocity in it or the iterations are used up.
  for (std::size_t group = 0; group < groups_.count(); ++group)
    for (int i = 0; i < info.m_numIterations; ++i)
      if (iterate(group, info.m_timeStep) <= info.m_leastSquaresResidualThreshold) break;

  // Impulses to where the next step finds them, velocities to Bullet.
  for (Contact& contact : contacts_) contact.finish();
  for (JointRows& joint : joints_) joint.finish();
  for (const SolverBody& body : bodies_) write_back(body);
}

SolverBody* ContactSolver::solver_body(const btCollisionObject& object) {
  return object.isStaticOrKinematicObject() ? nullptr : &bodies_[static_cast<std::size_t>(object.getCompanionId())];
}

std::size_t ContactSolver::group_of(const btCollisionObject& moving) const {
  return groups_.of(static_cast<std::size_t>(moving.getCompanionId()));
}

void ContactSolver::find_groups(btDispatcher& dispatcher, const btAlignedObjectArray<btTypedConstraint*>& joints) {
  const std::vector<BeltPair*>& pairs = belt_ground_.pairs();
  const auto manifolds = static_cast<std::size_t>(dispatcher.getNumManifolds());
  const auto each_touching = [&](const auto& use) {  // (number, body, other body)
    for (std::size_t m = 0; m < manifolds; ++m) {
      const btPersistentManifold& manifold = *dispatcher.getManifoldByIndexInternal(static_cast<int>(m));
      if (manifold.getNumContacts() > 0) use(m, *manifold.getBody0(), *manifold.getBody1());
    }
    for (std::size_t p = 0; p < pairs.size(); ++p)
      if (!pairs[p]->contacts.empty()) use(manifolds + p, *pairs[p]->body, *pairs[p]->ground);
  };
  const auto moves = [](const btCollisionObject& object) { return !object.isStaticOrKinematicObject(); };
  const auto join = [&](const btCollisionObject& a, const btCollisionObject& b) {
    if (moves(a) && moves(b))
      groups_.join(static_cast<std::size_t>(a.getCompanionId()), static_cast<std::size_t>(b.getCompanionId()));
  };

  // A joint or a contact joins two moving bodies into one group.
  groups_.begin(bodies_.size());
  for (int i = 0; i < joints.size(); ++i) join(joints[i]->getRigidBodyA(), joints[i]->getRigidBodyB());
  each_touching([&](std::size_t, const auto& a, const auto& b) { join(a, b); });
  groups_.number();

  // Joints, belts and touching pairs, sorted by group.
  joints_by_group_.begin();
  for (int i = 0; i < joints.size(); ++i) joints_by_group_.add(group_of(joints[i]->getRigidBodyA()));
  joints_by_group_.sort(groups_.count());
  belts_by_group_.begin();
  for (const BeltOfBody& of : belts_) belts_by_group_.add(group_of(*of.body));
  belts_by_group_.sort(groups_.count());
  touching_.clear();
  touching_by_group_.begin();
  each_touching([&](std::size_t number, const auto& a, const auto& b) {
    if (!moves(a) && !moves(b)) return;
    touching_.push_back(number);
    touching_by_group_.add(group_of(moves(a) ? a : b));
  });
  touching_by_group_.sort(groups_.count());
}

void ContactSolver::make_joints(const btAlignedObjectArray<btTypedConstraint*>& joints,
                                const btContactSolverInfo& info) {
  joints_.clear();
  for (const std::size_t i : joints_by_group_.all()) {
    btTypedConstraint& joint = *joints[static_cast<int>(i)];
    joints_.emplace_back(static_cast<FlipperJoint&>(joint), *solver_body(joint.getRigidBodyA()),
                         *solver_body(joint.getRigidBodyB()), info);
  }
}

void ContactSolver::make_contacts(btDispatcher& dispatcher, btScalar time_step) {
  // exp(-h (|u| / 20 mm + 1 / 0.5 s)) of the friction impulses is left to start from.
  for (const auto& [belt, body] : belts_)
    belt->warm_start_share = std::exp(-time_step * (std::abs(belt->speed_mps) / kRenewal_m + 1 / kCreep_s));

  // Group by group, the contacts of its manifolds and belt pairs.
  const auto manifolds = static_cast<std::size_t>(dispatcher.getNumManifolds());
  contacts_.clear();
  some_shear_ = false;
  contacts_end_.clear();
  for (std::size_t group = 0; group < groups_.count(); ++group) {
    for (std::size_t i = touching_by_group_.begin_of(group); i < touching_by_group_.end_of(group); ++i) {
      const std::size_t number = touching_[touching_by_group_.all()[i]];
      if (number < manifolds)
        add_manifold(*dispatcher.getManifoldByIndexInternal(static_cast<int>(number)), time_step);
      else
        add_belt_pair(*belt_ground_.pairs()[number - manifolds], time_step);
    }
    contacts_end_.push_back(contacts_.size());
  }
}

// Warm start of the belts' own impulses: motor and running gear.
void ContactSolver::start_belts() {
  for (const auto& [belt, body] : belts_) {
    belt->motor_impulse_ns =
        std::clamp(belt->warm_start_share * belt->motor_impulse_ns, belt->min_impulse_ns, belt->max_impulse_ns);
    belt->friction_impulse_ns *= belt->warm_start_share;
    belt->viscous_impulse_ns *= belt->warm_start_share;
    belt->speed_mps +=
        (belt->motor_impulse_ns + belt->friction_impulse_ns + belt->viscous_impulse_ns) / belt->moving_mass_kg;
    belt->load_ns = 0;
  }
}

btScalar ContactSolver::iterate(std::size_t group, btScalar time_step) {
  btScalar residual = 0;
  for (std::size_t i = joints_by_group_.begin_of(group); i < joints_by_group_.end_of(group); ++i)
    residual = btMax(residual, joints_[i].solve());
  for (std::size_t i = belts_by_group_.begin_of(group); i < belts_by_group_.end_of(group); ++i)
    residual = std::max(residual, solve_running_gear(*belts_[belts_by_group_.all()[i]].belt, time_step));
  const std::size_t first = group == 0 ? 0 : contacts_end_[group - 1];
  return std::max(residual,
                  Contact::solve(std::span(contacts_).subspan(first, contacts_end_[group] - first), some_shear_));
}

void ContactSolver::add_manifold(btPersistentManifold& manifold, btScalar time_step) {
  const btCollisionObject *body0 = manifold.getBody0(), *body1 = manifold.getBody1();
  SolverBody *solver0 = solver_body(*body0), *solver1 = solver_body(*body1);
  for (int i = 0; i < manifold.getNumContacts(); ++i) {
    btManifoldPoint& point = manifold.getContactPoint(i);
    const Surface& surface0 = surface_of(*body0, point.m_index0);
    const Surface& surface1 = surface_of(*body1, point.m_index1);
    // One point for both bodies, so that the two impulses cancel in moment too.
    const btVector3 p_W = (point.getPositionWorldOnA() + point.getPositionWorldOnB()) * 0.5;
    // Bullet keeps these impulses with a point that it finds again, but no directions: they are along this contact's
    // own axes.
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
  const Shearing shearing = shearing_of(*pair.belt, belt_ground_.pairs());
  some_shear_ |= shearing.rate > 0;
  const Meeting meeting(*pair.body, *pair.ground, solver_body(*pair.body), solver_body(*pair.ground),
                        pair.belt->surface, surface_of(*pair.ground, 0));
  for (BeltContact& contact : pair.contacts) {
    const BeltTouch& at = contact.touch;
    const Touch touch{pair.X_WT * at.p_T,
                      pair.X_WT.getBasis() * at.normal_T,
                      at.gap_m,
                      at.weight,
                      at.holds_lugs,
                      {&contact.impulse[0], &contact.impulse[1], &contact.impulse[2]},
                      shearing.rate > 0 ? stretch_of(*pair.belt, at, shearing) : ShearStretch{}};
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

  // Motor: speed = target - droop * impulse, with both after a change c of the impulse: u + c / m = target - droop
  // (p + c), so c = (target - u - droop p) m / (1 + droop m). Without droop the speed becomes the target.
  const double short_mps = belt.target_mps - belt.speed_mps - belt.droop_mpspns * belt.motor_impulse_ns;
  push(belt.motor_impulse_ns, belt.motor_impulse_ns + short_mps * m / (1 + belt.droop_mpspns * m), belt.min_impulse_ns,
       belt.max_impulse_ns);

  // Viscous friction, implicit: p = -d u with u = u_free + p / m after it, so p = -u_free / (1 / d + 1 / m).
  if (const double damping_ns = belt.viscous_nspm * time_step; damping_ns > 0) {
    const double free_mps = belt.speed_mps - belt.viscous_impulse_ns / m;
    push(belt.viscous_impulse_ns, -free_mps / (1 / damping_ns + 1 / m), -1e9, 1e9);
  }

  // Dry and rolling friction: the impulse that stops the belt, within its limit. With a limit of 0 too if there is an
  // impulse, of the warm start or of an earlier iteration: that one has to go. The load is a sum of changes, which
  // rounding may leave below 0.
  if (const double dry_ns = belt.dry_friction_ns + belt.rolling_resistance * std::max(belt.load_ns, 0.0);
      dry_ns > 0 || belt.friction_impulse_ns != 0)
    push(belt.friction_impulse_ns, belt.friction_impulse_ns - belt.speed_mps * m, -dry_ns, dry_ns);
  return changed;
}

}  // namespace kenaf::physics
