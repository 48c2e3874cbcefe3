#include "physics/dynamics/contact_solver.hpp"

#include <algorithm>

#include "physics/dynamics/contact_iterations.hpp"

namespace kenaf::physics {
namespace {

const Surface& surface_of(const btCollisionObject& body, int child) {
  const auto& collider = *static_cast<const Collider*>(body.getUserPointer());
  const auto i = static_cast<std::size_t>(child);
  return collider.surfaces[i < collider.surfaces.size() ? i : 0];
}

}  // namespace

void ContactSolver::add_belt(Belt* belt, const btRigidBody* body) {
  belts_.push_back({belt, body});
  contacts_.reserve(kManyContacts * belts_.size());
  patches_.reserve(kManyContacts * belts_.size());
  touching_.reserve(kManyContacts * belts_.size());
  touching_by_group_.make_room(kManyContacts * belts_.size());
  belt_ground_.make_room(kManyPairs * belts_.size());
}

void ContactSolver::remove_belt(Belt* belt) {
  std::erase_if(belts_, [belt](const BeltOfBody& of) { return of.belt == belt; });
}

void ContactSolver::forget_contacts_of(const btCollisionObject& object) {
  const void* collider = object.getUserPointer();
  auto contact = contacts_.begin();
  for (ContactPatch& patch : patches_) {
    const auto end = contact + static_cast<std::ptrdiff_t>(patch.contact_count);
    const bool forgotten = patch.collider_a == collider || patch.collider_b == collider;
    contact = forgotten ? contacts_.erase(contact, end) : end;
    if (forgotten) patch.contact_count = 0;
  }
}

void ContactSolver::solve(btAlignedObjectArray<btRigidBody*>& bodies, btDispatcher& dispatcher,
                          btAlignedObjectArray<btTypedConstraint*>& joints, const btContactSolverInfo& info) {
  // Bodies, groups and contacts; an impulse starts from the last step's.
  assemble(bodies, joints, info);
  find_groups(dispatcher);
  for (const auto& [belt, body] : belts_) start_step(*belt, info.m_timeStep);
  make_contacts(dispatcher, info.m_timeStep);
  for_each_patch(std::span(patches_), std::span(contacts_), [](const ContactPatch& patch, std::span<Contact> contacts) {
    const auto count = static_cast<int>(std::ranges::count_if(contacts, &Contact::may_press));
    for (const BodyInPatch* of : {&patch.a, &patch.b})
      if (of->moves.body) of->moves.body->contact_count += count;
  });
  warm_start(patches_, contacts_);

  for (std::size_t group = 0; group < groups_.count(); ++group) solve_group(group, info);

  // Impulses to where the next step finds them, velocities to Bullet.
  let_friction_creep();
  for (const Contact& contact : contacts_) contact.keep_impulses();
  for (const auto& [belt, body] : belts_) finish_step(*belt);
  for (const ArticulatedBody& body : bodies_) write_back(body);
}

void ContactSolver::assemble(btAlignedObjectArray<btRigidBody*>& bodies,
                             const btAlignedObjectArray<btTypedConstraint*>& joints, const btContactSolverInfo& info) {
  // Joints by the body that carries the arm.
  const auto count = static_cast<std::size_t>(bodies.size());
  for (int i = 0; i < bodies.size(); ++i) bodies[i]->setCompanionId(i);
  joints_by_base_.begin();
  for (int i = 0; i < joints.size(); ++i)
    joints_by_base_.add(static_cast<std::size_t>(joints[i]->getRigidBodyA().getCompanionId()));
  joints_by_base_.sort(count);
  arms_.clear();
  sides_.assign(count, {});
  for (const std::size_t i : joints_by_base_.all()) {
    Arm& arm = arms_.emplace_back();
    arm.joint = static_cast<FlipperJoint*>(joints[static_cast<int>(i)]);
    arm.body = &arm.joint->getRigidBodyB();
  }
  for (Arm& arm : arms_) sides_[static_cast<std::size_t>(arm.body->getCompanionId())].arm = &arm;

  // A body that is no arm carries its arms. No pointer into bodies_ is taken before the last one is in.
  bodies_.clear();
  bodies_.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    if (sides_[i].arm) continue;
    const std::size_t first = joints_by_base_.begin_of(i), end = joints_by_base_.end_of(i);
    bodies_.push_back(to_solver(*bodies[static_cast<int>(i)], std::span(arms_).subspan(first, end - first),
                                info.m_timeStep, 1 / info.m_timeStep * info.m_erp));
    sides_[i].body = &bodies_.back();
    for (std::size_t k = first; k < end; ++k)
      sides_[static_cast<std::size_t>(arms_[k].body->getCompanionId())].body = &bodies_.back();
  }
}

ContactSide ContactSolver::side_of(const btCollisionObject& object) const {
  return object.isStaticOrKinematicObject() ? ContactSide{} : sides_[static_cast<std::size_t>(object.getCompanionId())];
}

std::size_t ContactSolver::group_of(const btCollisionObject& moving) const {
  return groups_.of(static_cast<std::size_t>(side_of(moving).body - bodies_.data()));
}

void ContactSolver::find_groups(btDispatcher& dispatcher) {
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

  // A contact joins two moving bodies into one group.
  groups_.begin(bodies_.size());
  each_touching([&](std::size_t, const auto& a, const auto& b) {
    if (!moves(a) || !moves(b)) return;
    groups_.join(static_cast<std::size_t>(side_of(a).body - bodies_.data()),
                 static_cast<std::size_t>(side_of(b).body - bodies_.data()));
  });
  groups_.number();

  // Bodies, belts and touching pairs, sorted by group.
  bodies_by_group_.begin();
  for (std::size_t i = 0; i < bodies_.size(); ++i) bodies_by_group_.add(groups_.of(i));
  bodies_by_group_.sort(groups_.count());
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

void ContactSolver::make_contacts(btDispatcher& dispatcher, btScalar time_step) {
  const auto manifolds = static_cast<std::size_t>(dispatcher.getNumManifolds());
  contacts_.clear();
  patches_.clear();
  some_shear_ = false;
  contacts_end_.clear();
  patches_end_.clear();
  for (std::size_t group = 0; group < groups_.count(); ++group) {
    for (std::size_t i = touching_by_group_.begin_of(group); i < touching_by_group_.end_of(group); ++i) {
      const std::size_t number = touching_[touching_by_group_.all()[i]];
      if (number < manifolds)
        add_manifold(*dispatcher.getManifoldByIndexInternal(static_cast<int>(number)), time_step);
      else
        add_belt_pair(*belt_ground_.pairs()[number - manifolds], time_step);
    }
    contacts_end_.push_back(contacts_.size());
    patches_end_.push_back(patches_.size());
  }
}

std::span<ContactPatch> ContactSolver::patches_of(std::size_t group) {
  const std::size_t first = group == 0 ? 0 : patches_end_[group - 1];
  return std::span(patches_).subspan(first, patches_end_[group] - first);
}

std::span<Contact> ContactSolver::contacts_of(std::size_t group) {
  const std::size_t first = group == 0 ? 0 : contacts_end_[group - 1];
  return std::span(contacts_).subspan(first, contacts_end_[group] - first);
}

// Until an iteration changes no velocity of the group, the iterations are used up, or they gain nothing any more: while
// contacts slip by less than gravity's change in a step, as in a straight drive whose belts differ by a trifle, each
// iteration turns their friction by a few percent of the way only. The first ones share what several contacts could
// hold evenly: what holds the robot straight, the two tracks or the friction across them, is not determined, and one
// after the other the first track would pull alone. At which limits motors and servos are is looked at by the impulses
// to start from, then on the way and at the end; where it is not what was assumed, the group begins anew with the
// impulses that it has.
void ContactSolver::solve_group(std::size_t group, const btContactSolverInfo& info) {
  constexpr int kIterationsToLook = 3;
  // So many iterations, and left and right track pull alike within 1 %.
  constexpr int kShared = 4;
  // An iteration gains nothing that makes this share of the change by the one before, after that share of all that may
  // be made: more iterations solve more exactly.
  constexpr btScalar kGainsNothing = 0.9, kPatient = 0.6;
  constexpr int kMostTimesAnew = 8;
  solve_friction_of_belts(group);
  if (settle_motors(group)) make_anew(group);
  int times_anew = 0;
  btScalar squared_before = 0;
  for (int i = 1; i <= info.m_numIterations; ++i) {
    const btScalar squared_change = iterate(group, i <= kShared ? Iteration::shared : Iteration::one_by_one);
    const bool gains_nothing =
        i > kPatient * info.m_numIterations && squared_change > kGainsNothing * kGainsNothing * squared_before;
    const bool solved = squared_change <= info.m_leastSquaresResidualThreshold || gains_nothing;
    squared_before = squared_change;
    const bool look = solved || i == info.m_numIterations || i % kIterationsToLook == 0;
    if (look && times_anew < kMostTimesAnew && settle_motors(group)) {
      make_anew(group);
      ++times_anew;
      i = 0;
    } else if (solved) {
      break;
    }
  }
}

btScalar ContactSolver::solve_friction_of_belts(std::size_t group) {
  btScalar residual = 0;
  for (std::size_t i = belts_by_group_.begin_of(group); i < belts_by_group_.end_of(group); ++i)
    residual = std::max(residual, solve_friction(*belts_[belts_by_group_.all()[i]].belt));
  return residual;
}

btScalar ContactSolver::iterate(std::size_t group, Iteration how) {
  const btScalar residual = solve_friction_of_belts(group);
  const auto iteration = how == Iteration::shared ? share_evenly : solve_in_turn;
  return std::max(residual, iteration(patches_of(group), contacts_of(group), some_shear_));
}

bool ContactSolver::settle_motors(std::size_t group) {
  bool changed = false;
  for (std::size_t i = belts_by_group_.begin_of(group); i < belts_by_group_.end_of(group); ++i)
    changed |= settle_motor(*belts_[belts_by_group_.all()[i]].belt);
  for (std::size_t i = bodies_by_group_.begin_of(group); i < bodies_by_group_.end_of(group); ++i)
    changed |= settle_servos(bodies_[bodies_by_group_.all()[i]]);
  return changed;
}

void ContactSolver::make_anew(std::size_t group) {
  for (std::size_t i = belts_by_group_.begin_of(group); i < belts_by_group_.end_of(group); ++i)
    begin_anew(*belts_[belts_by_group_.all()[i]].belt);
  for (std::size_t i = bodies_by_group_.begin_of(group); i < bodies_by_group_.end_of(group); ++i)
    begin_anew(bodies_[bodies_by_group_.all()[i]]);
  for_each_patch(patches_of(group), contacts_of(group), [](ContactPatch& patch, std::span<Contact> contacts) {
    patch.take_bodies();
    for (Contact& contact : contacts) contact.take_bodies(patch);
  });
  warm_start(patches_of(group), contacts_of(group));
}

void ContactSolver::let_friction_creep() {
  creeps_.assign(bodies_.size(), {});
  given_back_.resize(bodies_.size());
  const auto number_of = [&](const ContactPatch& patch) {
    return static_cast<std::size_t>(patch.a.moves.body - bodies_.data());
  };

  // What contacts that stick lose, and what those lose that hold a body by themselves.
  for_each_patch(std::span(patches_), std::span(contacts_),
                 [&](const ContactPatch& patch, std::span<Contact> contacts) {
                   InPatch lost{};
                   btScalar pressing_ns = 0;
                   for (Contact& contact : contacts) {
                     if (!contact.sticks()) continue;
                     lost = lost + impulse_at(contact.from_a(), 0, (1 - patch.fading) * contact.friction_impulse());
                     pressing_ns += contact.normal_impulse();
                     contact.set_friction(patch.fading * contact.friction_impulse());
                   }
                   if (patch.moves_base_alone()) creeps_[number_of(patch)].lose(patch, lost, pressing_ns);
                 });
  if (std::ranges::none_of(creeps_, &FrictionCreep::matters)) return;

  // What holds a body comes back.
  for_each_patch(std::span(patches_), std::span(contacts_),
                 [&](const ContactPatch& patch, std::span<Contact> contacts) {
                   FrictionCreep& creep = creeps_[number_of(patch)];
                   if (!patch.moves_base_alone() || !creep.matters()) return;
                   SpringsInPatch springs;
                   for (const Contact& contact : contacts)
                     if (contact.sticks()) springs.add(contact.from_a(), contact.normal_impulse());
                   creep.add_springs(patch, springs);
                 });
  std::ranges::transform(creeps_, given_back_.begin(), [](const FrictionCreep& creep) {
    return creep.matters() ? creep.given_back() : TwoVectors{};
  });
  for_each_patch(
      std::span(patches_), std::span(contacts_), [&](const ContactPatch& patch, std::span<Contact> contacts) {
        if (!patch.moves_base_alone()) return;
        const InPatch given_back = patch.in_patch(given_back_[number_of(patch)]);
        for (Contact& contact : contacts)
          if (contact.sticks())
            contact.set_friction(contact.friction_impulse() +
                                 contact.normal_impulse() * tangential_velocity(given_back, contact.from_a()));
      });
}

void ContactSolver::add_contact(const Meeting& meeting, bool same_meeting, const Touch& touch, btScalar time_step) {
  constexpr btScalar kSameSquared = 1e-20;  // of the difference of two unit normals
  if (!same_meeting || patches_.back().holds_lugs != touch.holds_lugs ||
      (patches_.back().normal_W - touch.normal_W).length2() > kSameSquared)
    patches_.emplace_back(meeting, touch.normal_W, touch.holds_lugs);
  contacts_.emplace_back(patches_.back(), touch, settings_, time_step);
  ++patches_.back().contact_count;
}

void ContactSolver::add_manifold(btPersistentManifold& manifold, btScalar time_step) {
  const btCollisionObject *body0 = manifold.getBody0(), *body1 = manifold.getBody1();
  const ContactSide side0 = side_of(*body0), side1 = side_of(*body1);
  const Surface *last0 = nullptr, *last1 = nullptr;
  for (int i = 0; i < manifold.getNumContacts(); ++i) {
    btManifoldPoint& point = manifold.getContactPoint(i);
    const Surface& surface0 = surface_of(*body0, point.m_index0);
    const Surface& surface1 = surface_of(*body1, point.m_index1);
    // One point for both bodies, so that the two impulses cancel in moment too.
    const btVector3 p_W = (point.getPositionWorldOnA() + point.getPositionWorldOnB()) * 0.5;
    // Bullet keeps these impulses with a point that it finds again, but no directions: they are along this contact's
    // own axes.
    const Touch touch{p_W,
                      side0.body ? point.m_normalWorldOnB : -point.m_normalWorldOnB,
                      point.getDistance(),
                      1,
                      false,
                      {&point.m_appliedImpulse, &point.m_appliedImpulseLateral1, &point.m_appliedImpulseLateral2}};
    const Meeting meeting = side0.body ? Meeting(*body0, *body1, side0, side1, surface0, surface1)
                                       : Meeting(*body1, *body0, side1, {}, surface1, surface0);
    add_contact(meeting, last0 == &surface0 && last1 == &surface1, touch, time_step);
    last0 = &surface0;
    last1 = &surface1;
  }
}

void ContactSolver::add_belt_pair(BeltPair& pair, btScalar time_step) {
  const Shearing shearing = shearing_of(*pair.belt, belt_ground_.pairs());
  some_shear_ |= shearing.rate > 0;
  const Meeting meeting(*pair.body, *pair.ground, side_of(*pair.body), side_of(*pair.ground), pair.belt->surface,
                        surface_of(*pair.ground, 0));
  bool first = true;
  for (BeltContact& contact : pair.contacts) {
    const BeltTouch& at = contact.touch;
    const Touch touch{pair.X_WT * at.p_T,
                      pair.X_WT.getBasis() * at.normal_T,
                      at.gap_m,
                      at.weight,
                      at.holds_lugs,
                      {&contact.impulse[0], &contact.impulse[1], &contact.impulse[2]},
                      shearing.rate > 0 ? stretch_of(*pair.belt, at, shearing) : ShearStretch{}};
    add_contact(meeting, !first, touch, time_step);
    first = false;
  }
}

}  // namespace kenaf::physics
