#include "physics/contact_solver.hpp"

#include <algorithm>
#include <cmath>

#include "physics/flipper_joint.hpp"

namespace kenaf::physics {
namespace {

// Tracks that once pulled against each other must not do so for ever: a belt that rolls brings unloaded rubber into
// contact, and rubber creeps. After this way or time, 1/e of an old friction impulse is left to start from.
constexpr double kRenewal_m = 0.02;
constexpr double kCreep_s = 0.5;
constexpr btScalar kLeastFriction = 1e-6;  // for the ellipse of a surface that slides freely in one direction
constexpr btScalar kEdgeRadius_m = 0.01;   // of timber and concrete
constexpr btScalar kMostGrip = 10;         // a lug that is wholly behind an edge
constexpr btScalar kSideFace = 0.1;  // |normal x belt axis| below which a surface is a side face without direction

const Surface& surface_of(const Collider& collider, int child) {
  const auto i = static_cast<std::size_t>(child);
  return collider.surfaces[i < collider.surfaces.size() ? i : 0];
}

// Where a point of the belt moves, for a belt speed of -1: along the belt, shorter towards the side faces. Drake's
// multibody plant defines a surface velocity so (speed * axis x normal).
btVector3 belt_direction(const Surface& surface, const btCollisionObject& body, const btVector3& outward_W) {
  if (!surface.belt) return {0, 0, 0};
  return outward_W.cross(body.getWorldTransform().getBasis().getColumn(1) * surface.axis_y);
}

// An edge is a little round, and a lug that meets it is to it what a step is to a wheel: the lug's corner presses on
// the edge at an angle b from the belt's normal, cos b = 1 - height / radius, and holds up to tan(friction angle + b).
btScalar grip_at_edge(btScalar mu, btScalar lug_height_m) {
  if (lug_height_m <= 0) return mu;
  const btScalar cosine = 1 - std::min(lug_height_m / kEdgeRadius_m, btScalar(1));
  const btScalar sine = std::sqrt(1 - cosine * cosine);
  const btScalar rise = mu * cosine + sine, run = cosine - mu * sine;
  return rise < kMostGrip * run ? rise / run : kMostGrip;
}

// Of a belt's speed, what moves the surface.
btScalar driving_share(const Belt& belt) {
  return 1 - std::min(belt.slip_spm * std::abs(belt.speed_mps), 1.0);
}

// A belt that keeps its speed takes from its motor what a contact takes from it.
void hold_against(Belt& belt, const btScalar gain[2], const btScalar impulse[3]) {
  if (std::isinf(belt.moving_mass_kg)) belt.motor_impulse_ns -= gain[0] * impulse[1] + gain[1] * impulse[2];
}

}  // namespace

void ContactSolver::forget_contacts_of(const btCollisionObject& object) {
  const void* collider = object.getUserPointer();
  std::erase_if(contacts_,
                [collider](const Contact& c) { return c.collider_a == collider || c.collider_b == collider; });
}

btScalar ContactSolver::solveGroup(btCollisionObject** bodies, int body_count, btPersistentManifold** manifolds,
                                   int manifold_count, btTypedConstraint** constraints, int constraint_count,
                                   const btContactSolverInfo& info, btIDebugDraw* debug, btDispatcher* dispatcher) {
  // a step's second call is for what the islands left over, which is nothing; belts must not be solved twice
  if (body_count == 0) return 0;
  return btSequentialImpulseConstraintSolver::solveGroup(bodies, body_count, manifolds, manifold_count, constraints,
                                                         constraint_count, info, debug, dispatcher);
}

void ContactSolver::convertContacts(btPersistentManifold** manifolds, int count, const btContactSolverInfo& info) {
  contacts_.clear();
  for (Belt* belt : belts_)
    belt->kept = std::exp(-info.m_timeStep * (std::abs(belt->speed_mps) / kRenewal_m + 1 / kCreep_s));
  for (int m = 0; m < count; ++m) add_manifold(*manifolds[m], info.m_timeStep);
  for (BeltPair* pair : belt_ground_.pairs()) add_belt_pair(*pair, info.m_timeStep);
  for (Belt* belt : belts_) {
    belt->motor_impulse_ns =
        std::clamp(belt->kept * belt->motor_impulse_ns, belt->min_impulse_ns, belt->max_impulse_ns);
    belt->friction_impulse_ns *= belt->kept;
    belt->viscous_impulse_ns *= belt->kept;
    belt->speed_mps +=
        (belt->motor_impulse_ns + belt->friction_impulse_ns + belt->viscous_impulse_ns) / belt->moving_mass_kg;
    belt->load_ns = 0;
  }
  for (Contact& contact : contacts_) warm_start(contact);
}

void ContactSolver::add_manifold(btPersistentManifold& manifold, btScalar time_step) {
  auto* body0 = const_cast<btCollisionObject*>(manifold.getBody0());
  auto* body1 = const_cast<btCollisionObject*>(manifold.getBody1());
  const bool moves0 = !body0->isStaticOrKinematicObject(), moves1 = !body1->isStaticOrKinematicObject();
  if (manifold.getNumContacts() == 0 || (!moves0 && !moves1)) return;
  const int id0 = getOrInitSolverBody(*body0, time_step);
  const int id1 = getOrInitSolverBody(*body1, time_step);
  for (int i = 0; i < manifold.getNumContacts(); ++i) {
    btManifoldPoint& point = manifold.getContactPoint(i);
    const Surface& surface0 = surface_of(*static_cast<const Collider*>(body0->getUserPointer()), point.m_index0);
    const Surface& surface1 = surface_of(*static_cast<const Collider*>(body1->getUserPointer()), point.m_index1);
    // one point for both bodies, so that the two impulses cancel in moment too
    const btVector3 p_W = (point.getPositionWorldOnA() + point.getPositionWorldOnB()) * 0.5;
    // Bullet keeps these numbers with a point that it finds again, and no directions: they are along this contact's
    // own axes
    const Touch touch{p_W,
                      moves0 ? point.m_normalWorldOnB : -point.m_normalWorldOnB,
                      point.getDistance(),
                      1,
                      false,
                      moves0 ? surface0 : surface1,
                      moves0 ? surface1 : surface0,
                      {&point.m_appliedImpulse, &point.m_appliedImpulseLateral1, &point.m_appliedImpulseLateral2}};
    if (moves0)
      add_contact(touch, *body0, *body1, id0, id1, time_step);
    else
      add_contact(touch, *body1, *body0, id1, id0, time_step);
  }
}

void ContactSolver::add_belt_pair(BeltPair& pair, btScalar time_step) {
  if (pair.contacts.empty()) return;
  auto* body = const_cast<btCollisionObject*>(pair.body);
  auto* ground = const_cast<btCollisionObject*>(pair.ground);
  const int id_a = getOrInitSolverBody(*body, time_step), id_b = getOrInitSolverBody(*ground, time_step);
  const Surface& other = surface_of(*static_cast<const Collider*>(ground->getUserPointer()), 0);
  for (BeltContact& contact : pair.contacts) {
    const BeltTouch& at = contact.touch;
    add_contact({pair.X_WT * at.p_T,
                 pair.X_WT.getBasis() * at.normal_T,
                 at.gap_m,
                 at.share,
                 at.edge,
                 pair.belt->surface,
                 other,
                 {&contact.impulse[0], &contact.impulse[1], &contact.impulse[2]}},
                *body, *ground, id_a, id_b, time_step);
  }
}

void ContactSolver::add_contact(const Touch& touch, const btCollisionObject& a, const btCollisionObject& b, int body_a,
                                int body_b, btScalar time_step) {
  Contact& c = contacts_.emplace_back();
  for (int k = 0; k < 3; ++k) c.kept[k] = touch.kept[k];
  c.collider_a = static_cast<const Collider*>(a.getUserPointer());
  c.collider_b = static_cast<const Collider*>(b.getUserPointer());
  c.body_a = body_a;
  c.body_b = body_b;
  c.b_moves = !b.isStaticOrKinematicObject();
  c.p_W = touch.p_W;
  const Surface &surface_a = touch.surface_a, &surface_b = touch.surface_b;
  c.belt_a = surface_a.belt;
  c.belt_b = surface_b.belt;
  const btVector3& normal = touch.normal_W;
  const btVector3 belt_a = belt_direction(surface_a, a, -normal);
  const btVector3 belt_b = belt_direction(surface_b, b, normal);

  c.mu[0] = surface_a.friction_along * surface_b.friction_along;
  c.mu[1] = surface_a.friction_across * surface_b.friction_across;
  if (touch.edge) c.mu[0] = grip_at_edge(c.mu[0], surface_a.lug_height_m);
  c.axis[0] = normal;
  if (belt_a.length2() > kSideFace * kSideFace) {
    c.axis[1] = belt_a.normalized();
  } else if (belt_b.length2() > kSideFace * kSideFace) {
    c.axis[1] = belt_b.normalized();
  } else {
    btVector3 unused;
    btPlaneSpace1(normal, c.axis[1], unused);
    c.mu[0] = c.mu[1];
  }
  c.axis[2] = normal.cross(c.axis[1]);
  for (int k = 0; k < 2; ++k) {
    c.belt_gain_a[k] = c.belt_a ? -belt_a.dot(c.axis[k + 1]) * driving_share(*c.belt_a) : 0;
    c.belt_gain_b[k] = c.belt_b ? belt_b.dot(c.axis[k + 1]) * driving_share(*c.belt_b) : 0;
    c.belt_push_a[k] = c.belt_a ? c.belt_gain_a[k] / c.belt_a->moving_mass_kg : 0;
    c.belt_push_b[k] = c.belt_b ? c.belt_gain_b[k] / c.belt_b->moving_mass_kg : 0;
  }

  const btSolverBody& A = m_tmpSolverBodyPool[body_a];
  const btSolverBody& B = m_tmpSolverBodyPool[body_b];
  c.inverse_mass_a = A.m_originalBody->getInvMass();
  c.inverse_mass_b = c.b_moves ? B.m_originalBody->getInvMass() : 0;
  const btVector3 r_a = c.p_W - A.getWorldTransform().getOrigin();
  const btVector3 r_b = c.b_moves ? c.p_W - B.getWorldTransform().getOrigin() : btVector3(0, 0, 0);
  btVector3 velocity_a, velocity_b;
  A.getVelocityInLocalPointNoDelta(r_a, velocity_a);
  B.getVelocityInLocalPointNoDelta(r_b, velocity_b);
  for (int k = 0; k < 3; ++k) {
    c.push_a[k] = c.axis[k] * c.inverse_mass_a;
    c.arm_a[k] = r_a.cross(c.axis[k]);
    c.turn_a[k] = A.m_originalBody->getInvInertiaTensorWorld() * c.arm_a[k];
    if (c.b_moves) {
      c.arm_b[k] = r_b.cross(c.axis[k]);
      c.turn_b[k] = B.m_originalBody->getInvInertiaTensorWorld() * c.arm_b[k];
    }
    c.free_velocity[k] = c.axis[k].dot(velocity_a - velocity_b);
  }
  // velocity of row i for a unit impulse of row j; the axes are orthogonal
  const auto response = [&c](int i, int j) {
    btScalar k = c.arm_a[i].dot(c.turn_a[j]);
    if (c.b_moves) k += c.arm_b[i].dot(c.turn_b[j]);
    if (i == j) k += c.inverse_mass_a + c.inverse_mass_b;
    if (i > 0 && j > 0) {
      k += c.belt_gain_a[i - 1] * c.belt_push_a[j - 1] + c.belt_gain_b[i - 1] * c.belt_push_b[j - 1];
    }
    return k;
  };

  // spring and damper, implicit: impulse = -h (k (gap + h v) + d v), never negative
  const btScalar stiffness =
      settings_.stiffness_npm * touch.share / (surface_a.compliance_scale * surface_b.compliance_scale);
  const btScalar damping = settings_.damping_nspm * touch.share * surface_a.damping_scale * surface_b.damping_scale;
  const btScalar step_stiffness = stiffness * time_step + damping;
  c.softness = 1 / (time_step * step_stiffness);
  c.give_velocity = -stiffness * touch.gap_m / step_stiffness;
  c.normal_mass = 1 / (response(0, 0) + c.softness);

  for (std::size_t k = 0; k < 2; ++k) {
    c.mu[k] = std::max(c.mu[k], kLeastFriction);
    c.inverse_mu[k] = 1 / c.mu[k];
  }
  const btScalar k11 = response(1, 1), k12 = response(1, 2), k22 = response(2, 2);
  const btScalar inverse_determinant = 1 / (k11 * k22 - k12 * k12);
  c.stick[0] = k22 * inverse_determinant;
  c.stick[1] = -k12 * inverse_determinant;
  c.stick[2] = k11 * inverse_determinant;
  // largest eigenvalue, with both directions scaled by their friction
  const btScalar s11 = k11 * c.mu[0] * c.mu[0], s12 = k12 * c.mu[0] * c.mu[1], s22 = k22 * c.mu[1] * c.mu[1];
  const btScalar difference = (s11 - s22) / 2;
  const btScalar largest = (s11 + s22) / 2 + std::sqrt(difference * difference + s12 * s12);
  c.slide_step = 1 / largest;
  c.normal_to_slip[0] = response(1, 0);
  c.normal_to_slip[1] = response(2, 0);

  c.impulse[0] = *c.kept[0];
  const btScalar kept = std::min(c.belt_a ? c.belt_a->kept : 1, c.belt_b ? c.belt_b->kept : 1);
  c.impulse[1] = kept * *c.kept[1];
  c.impulse[2] = kept * *c.kept[2];
}

// Inline: as a call it makes a step 8 % longer.
[[gnu::always_inline]] inline void ContactSolver::apply(Contact& c, const btScalar change[3]) {
  btSolverBody& A = m_tmpSolverBodyPool[c.body_a];
  A.internalGetDeltaLinearVelocity() += c.push_a[0] * change[0] + c.push_a[1] * change[1] + c.push_a[2] * change[2];
  A.internalGetDeltaAngularVelocity() += c.turn_a[0] * change[0] + c.turn_a[1] * change[1] + c.turn_a[2] * change[2];
  if (c.b_moves) {
    btSolverBody& B = m_tmpSolverBodyPool[c.body_b];
    const btVector3 impulse = c.axis[0] * change[0] + c.axis[1] * change[1] + c.axis[2] * change[2];
    B.internalGetDeltaLinearVelocity() -= impulse * c.inverse_mass_b;
    B.internalGetDeltaAngularVelocity() -= c.turn_b[0] * change[0] + c.turn_b[1] * change[1] + c.turn_b[2] * change[2];
  }
  if (c.belt_a) {
    c.belt_a->load_ns += change[0];
    c.belt_a->speed_mps += c.belt_push_a[0] * change[1] + c.belt_push_a[1] * change[2];
  }
  if (c.belt_b) {
    c.belt_b->load_ns += change[0];
    c.belt_b->speed_mps += c.belt_push_b[0] * change[1] + c.belt_push_b[1] * change[2];
  }
}

void ContactSolver::warm_start(Contact& c) {
  apply(c, c.impulse);
}

btScalar ContactSolver::solve_contact(Contact& c) {
  btSolverBody& A = m_tmpSolverBodyPool[c.body_a];
  btVector3 linear = A.internalGetDeltaLinearVelocity();
  const btVector3& angular_a = A.internalGetDeltaAngularVelocity();
  btScalar v[3];
  if (c.b_moves) {
    btSolverBody& B = m_tmpSolverBodyPool[c.body_b];
    linear -= B.internalGetDeltaLinearVelocity();
    const btVector3& angular_b = B.internalGetDeltaAngularVelocity();
    for (int k = 0; k < 3; ++k)
      v[k] = c.free_velocity[k] + c.axis[k].dot(linear) + c.arm_a[k].dot(angular_a) - c.arm_b[k].dot(angular_b);
  } else {
    for (int k = 0; k < 3; ++k) v[k] = c.free_velocity[k] + c.axis[k].dot(linear) + c.arm_a[k].dot(angular_a);
  }

  btScalar change[3];
  const btScalar normal =
      std::max(c.impulse[0] - (v[0] - c.give_velocity + c.softness * c.impulse[0]) * c.normal_mass, btScalar(0));
  change[0] = normal - c.impulse[0];
  if (normal <= 0 && c.impulse[0] <= 0 && c.impulse[1] == 0 && c.impulse[2] == 0) return 0;

  btScalar slip[2];
  for (int k = 0; k < 2; ++k) {
    slip[k] = v[k + 1] + c.normal_to_slip[k] * change[0];
    if (c.belt_a) slip[k] += c.belt_gain_a[k] * c.belt_a->speed_mps;
    if (c.belt_b) slip[k] += c.belt_gain_b[k] * c.belt_b->speed_mps;
  }
  btScalar p[2] = {0, 0};
  if (normal > 0) {
    // sticking: the impulse that stops the slip, if friction can give it
    p[0] = c.impulse[1] - c.stick[0] * slip[0] - c.stick[1] * slip[1];
    p[1] = c.impulse[2] - c.stick[1] * slip[0] - c.stick[2] * slip[1];
    const btScalar along = p[0] * c.inverse_mu[0], across = p[1] * c.inverse_mu[1];
    if (along * along + across * across > normal * normal) {
      // sliding: a step against the slip, then back onto the limit ellipse. In coordinates scaled by the friction
      // the ellipse is a circle, and the point where this rests is the one that dissipates most: the impulse
      // points against the slip (isotropic), or along the ellipse's normal there.
      const btScalar q0 = c.impulse[1] * c.inverse_mu[0] - c.slide_step * c.mu[0] * slip[0];
      const btScalar q1 = c.impulse[2] * c.inverse_mu[1] - c.slide_step * c.mu[1] * slip[1];
      const btScalar length = std::sqrt(q0 * q0 + q1 * q1);
      const btScalar scale = length > normal ? normal / length : 1;
      p[0] = q0 * scale * c.mu[0];
      p[1] = q1 * scale * c.mu[1];
    }
  }
  change[1] = p[0] - c.impulse[1];
  change[2] = p[1] - c.impulse[2];
  c.impulse[0] = normal;
  c.impulse[1] = p[0];
  c.impulse[2] = p[1];
  apply(c, change);
  return (change[0] * change[0] + change[1] * change[1] + change[2] * change[2]) * c.inverse_mass_a * c.inverse_mass_a;
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
  // without a load too: what rolling friction gave in the last step has to go
  if (const double dry_ns = belt.dry_friction_ns + belt.rolling_resistance * belt.load_ns;
      dry_ns > 0 || belt.friction_impulse_ns != 0)
    push(belt.friction_impulse_ns, belt.friction_impulse_ns - belt.speed_mps * m, -dry_ns, dry_ns);
  return changed;
}

btScalar ContactSolver::solveSingleIteration(int iteration, btCollisionObject** bodies, int body_count,
                                             btPersistentManifold** manifolds, int manifold_count,
                                             btTypedConstraint** constraints, int constraint_count,
                                             const btContactSolverInfo& info, btIDebugDraw* debug) {
  btScalar residual = btSequentialImpulseConstraintSolver::solveSingleIteration(
      iteration, bodies, body_count, manifolds, manifold_count, constraints, constraint_count, info, debug);
  for (Belt* belt : belts_) residual = std::max(residual, solve_running_gear(*belt, info.m_timeStep));
  for (Contact& contact : contacts_) residual = std::max(residual, solve_contact(contact));
  return residual;
}

btScalar ContactSolver::solveGroupCacheFriendlySetup(btCollisionObject** bodies, int body_count,
                                                     btPersistentManifold** manifolds, int manifold_count,
                                                     btTypedConstraint** constraints, int constraint_count,
                                                     const btContactSolverInfo& info, btIDebugDraw* debug) {
  const btScalar out = btSequentialImpulseConstraintSolver::solveGroupCacheFriendlySetup(
      bodies, body_count, manifolds, manifold_count, constraints, constraint_count, info, debug);
  // Bullet starts joints from zero in each step; with the last step's impulses a flipper holds its load in a few
  // iterations. Flipper joints are the only constraints there are.
  const FlipperJoint* joint = nullptr;
  for (int i = 0, row = 0; i < m_tmpSolverNonContactConstraintPool.size(); ++i, ++row) {
    btSolverConstraint& c = m_tmpSolverNonContactConstraintPool[i];
    const auto* owner = static_cast<const FlipperJoint*>(c.m_originalContactPoint);
    if (owner != joint) {
      joint = owner;
      row = 0;
    }
    if (row == 5 && joint->softness() > 0) {
      // a soft row of Bullet's own would not converge: it leaves the softness out of the row's mass
      const btScalar mass = 1 / (1 / c.m_jacDiagABInv + joint->softness());
      c.m_rhs *= mass / c.m_jacDiagABInv;
      c.m_cfm = joint->softness() * mass;
      c.m_jacDiagABInv = mass;
    }
    c.m_appliedImpulse = btClamped(joint->row_impulse[static_cast<std::size_t>(row)], c.m_lowerLimit, c.m_upperLimit);
    btSolverBody& A = m_tmpSolverBodyPool[c.m_solverBodyIdA];
    btSolverBody& B = m_tmpSolverBodyPool[c.m_solverBodyIdB];
    A.internalApplyImpulse(c.m_contactNormal1 * A.internalGetInvMass(), c.m_angularComponentA, c.m_appliedImpulse);
    B.internalApplyImpulse(c.m_contactNormal2 * B.internalGetInvMass(), c.m_angularComponentB, c.m_appliedImpulse);
  }
  return out;
}

btScalar ContactSolver::solveGroupCacheFriendlyFinish(btCollisionObject** bodies, int body_count,
                                                      const btContactSolverInfo& info) {
  for (Contact& c : contacts_) {
    for (int k = 0; k < 3; ++k) *c.kept[k] = c.impulse[k];
    if (c.belt_a) hold_against(*c.belt_a, c.belt_gain_a, c.impulse);
    if (c.belt_b) hold_against(*c.belt_b, c.belt_gain_b, c.impulse);
  }
  FlipperJoint* joint = nullptr;
  for (int i = 0, row = 0; i < m_tmpSolverNonContactConstraintPool.size(); ++i, ++row) {
    const btSolverConstraint& c = m_tmpSolverNonContactConstraintPool[i];
    auto* owner = static_cast<FlipperJoint*>(c.m_originalContactPoint);
    if (owner != joint) {
      joint = owner;
      row = 0;
    }
    joint->row_impulse[static_cast<std::size_t>(row)] = c.m_appliedImpulse;
  }
  return btSequentialImpulseConstraintSolver::solveGroupCacheFriendlyFinish(bodies, body_count, info);
}

}  // namespace kenaf::physics
