// What an iteration does with a contact: the change that it calls for, by itself, and how several are made.
#include <algorithm>
#include <cmath>

#include "physics/dynamics/contact.hpp"

namespace kenaf::physics {

// Inline: as a call it makes the computation of a time step 8 % slower.
template <bool kOnGround>
[[gnu::always_inline]] inline void Contact::apply(Moved a, btScalar normal, Two friction) {
  a.delta += rows_a_.response[0] * normal + rows_a_.response[1] * friction[0] + rows_a_.response[2] * friction[1];
  a.arm_nms += rows_a_.lever * normal + sum_of_lanes(rows_a_.levers * friction);
  a.load_ns += normal;
  a.belt_ns += sum_of_lanes(gain_a_ * friction);
  if constexpr (kOnGround) return;
  if (b_.body) {
    b_.body->delta -=
        rows_b_.response[0] * normal + rows_b_.response[1] * friction[0] + rows_b_.response[2] * friction[1];
    if (b_.arm) b_.arm->push_nms -= rows_b_.lever * normal + sum_of_lanes(rows_b_.levers * friction);
  }
  if (belt_b_) {
    belt_b_->load_ns += normal;
    belt_b_->push_ns += sum_of_lanes(gain_b_ * friction);
  }
}

void Contact::warm_start() {
  State none;
  apply<false>(in_place(none), normal_impulse_, friction_impulse_);
}

[[gnu::always_inline]] inline Two Contact::coulomb_friction(Two slip, btScalar normal) const {
  // Sticking: the impulse that stops the slip, if it lies within the limit ellipse.
  const Two friction = friction_impulse_ - stick_[0] * slip[0] - stick_[1] * slip[1];
  const Two scaled = friction * inverse_mu_;
  if (scaled[0] * scaled[0] + scaled[1] * scaled[1] <= normal * normal) return friction;
  // Sliding: projected gradient step, q - mu slip / eigenvalue, then back onto the circle of radius p_normal. Its fixed
  // point is the impulse of maximum dissipation: there the ellipse's normal points against the slip.
  const Two q = friction_impulse_ * inverse_mu_ - slide_step_ * slip;
  const btScalar length = std::sqrt(q[0] * q[0] + q[1] * q[1]);
  const btScalar scale = length > normal ? normal / length : 1;
  return q * scale * mu_;
}

// The impulse lies on the ellipse of p_normal times the share that has built up, where its normal points against the
// slip: p_i = -share p_normal mu_i² slip_i / |mu slip|, which is slip_i = -c_i p_i with a compliance of the row
//   c_i = |mu slip| / (p_normal share mu_i²).
// It is taken at the slip of now and solved with the row, implicitly: however steeply friction rises with slip, the
// impulse never jumps over the one that stops it. c_i grows with the slip, so repeating this comes to rest from one
// side.
[[gnu::noinline]] Two Contact::sheared_friction(Two slip, btScalar normal, btScalar share) const {
  const btScalar speed = std::sqrt(slip[0] * slip[0] + slip[1] * slip[1]);
  const Two scaled_slip = mu_ * slip;
  const btScalar mu = speed > 0 ? std::sqrt(scaled_slip[0] * scaled_slip[0] + scaled_slip[1] * scaled_slip[1]) / speed
                                : std::max(mu_[0], mu_[1]);
  const Two c = mu / (normal * sheared_share_per_slip(stretch_, speed)) * inverse_mu_ * inverse_mu_;

  // slip + K change = -c (p + change), solved for the change; K is the matrix from friction impulse to slip. With S its
  // inverse, which is at hand: (I + S c) change = -S (slip + c p).
  const Two left = slip + c * friction_impulse_;
  const Two stuck = stick_[0] * left[0] + stick_[1] * left[1];
  const Two column_0 = Two{1, 0} + stick_[0] * c[0], column_1 = Two{0, 1} + stick_[1] * c[1];
  const btScalar determinant = column_0[0] * column_1[1] - column_1[0] * column_0[1];
  const Two change =
      Two{column_1[1] * stuck[0] - column_1[0] * stuck[1], column_0[0] * stuck[1] - column_0[1] * stuck[0]} /
      -determinant;
  const Two friction = friction_impulse_ + share * change;

  // Never more than all of the friction, on the way there.
  const Two q = friction * inverse_mu_;
  const btScalar length = std::sqrt(q[0] * q[0] + q[1] * q[1]);
  return length > normal ? friction * (normal / length) : friction;
}

template <bool kOnGround, bool kSomeShear>
[[gnu::always_inline]] inline Contact::Change Contact::wanted_change(const Moved& a, btScalar share) const {
  // Normal: one Newton step of v - give_velocity + softness p = 0, clamped to p >= 0. A contact that is and stays open
  // changes nothing.
  const bool b_moves = !kOnGround && b_.body;
  const btScalar rate_a = a.arm_mobility * a.arm_nms;
  const btScalar rate_b = b_moves && b_.arm ? b_.arm->mobility * b_.arm->push_nms : 0;
  btScalar velocity = normal_velocity_ + sum_of_lanes(dot(rows_a_.row[0], a.delta)) + rows_a_.lever * rate_a;
  if (b_moves) velocity -= sum_of_lanes(dot(rows_b_.row[0], b_.body->delta)) + rows_b_.lever * rate_b;
  const btScalar mass = share == 1 ? normal_mass_ : share / (normal_mobility_ + share * softness_);
  const btScalar normal =
      std::max(normal_impulse_ - (velocity - give_velocity_ + softness_ * normal_impulse_) * mass, btScalar(0));
  const btScalar normal_change = normal - normal_impulse_;
  if (normal <= 0 && normal_impulse_ <= 0 && friction_impulse_[0] == 0 && friction_impulse_[1] == 0)
    return {0, Two{0, 0}, Two{0, 0}};

  // Friction: the slip with the normal's change and the belts' speeds in it.
  Two friction{0, 0}, slip{0, 0};
  if (normal > 0) {
    const Two along = dot(rows_a_.row[1], a.delta), across = dot(rows_a_.row[2], a.delta);
    slip = slip_ + Two{along[0], across[0]} + Two{along[1], across[1]} + rows_a_.levers * rate_a;
    if (b_moves) {
      const TwoVectors& delta_b = b_.body->delta;
      slip -= Two{sum_of_lanes(dot(rows_b_.row[1], delta_b)), sum_of_lanes(dot(rows_b_.row[2], delta_b))};
      slip -= rows_b_.levers * rate_b;
    }
    slip += normal_to_slip_ * normal_change;
    slip += gain_a_ * (a.belt_mobility * a.belt_ns);
    if (!kOnGround && belt_b_) slip += gain_b_ * (belt_b_->mobility_per_kg * belt_b_->push_ns);
    friction =
        kSomeShear && stretch_.to > 0 ? sheared_friction(slip, normal, share) : coulomb_friction(share * slip, normal);
  }
  return {normal_change, friction - friction_impulse_, slip};
}

template <bool kOnGround>
[[gnu::always_inline]] inline void Contact::make(const Change& change, const Moved& a) {
  normal_impulse_ += change.normal;
  friction_impulse_ += change.friction;
  last_slip_ = change.slip;
  apply<kOnGround>(a, change.normal, change.friction);
}

// The squared velocity change of A.
btScalar Contact::residual_of(const Change& change) const {
  const Two squares = change.friction * change.friction;
  return (change.normal * change.normal + squares[0] + squares[1]) * inverse_mass_a_ * inverse_mass_a_;
}

Contact::Moved Contact::in_place(State& none) const {
  return {.delta = a_.body->delta,
          .arm_nms = a_.arm ? a_.arm->push_nms : none.arm_nms,
          .belt_ns = belt_a_ ? belt_a_->push_ns : none.belt_ns,
          .load_ns = belt_a_ ? belt_a_->load_ns : none.load_ns,
          .arm_mobility = a_.arm ? a_.arm->mobility : 0,
          .belt_mobility = belt_a_ ? belt_a_->mobility_per_kg : 0};
}

// The contacts at the front that move the same things, on fixed ground.
std::span<Contact> Contact::run_at_front(std::span<Contact> contacts) {
  const Contact& first = contacts.front();
  std::size_t count = 1;
  while (count < contacts.size() && contacts[count].on_ground() && contacts[count].a_.body == first.a_.body &&
         contacts[count].a_.arm == first.a_.arm && contacts[count].belt_a_ == first.belt_a_)
    ++count;
  return contacts.first(count);
}

template <bool kSomeShear>
btScalar Contact::solve_each(std::span<Contact> contacts) {
  btScalar residual = 0;
  State none;
  while (!contacts.empty()) {
    Contact& first = contacts.front();
    const Moved place = first.in_place(none);
    // Between moving things: one at a time, in place.
    if (!first.on_ground()) {
      const Change change = first.wanted_change<false, kSomeShear>(place, 1);
      first.make<false>(change, place);
      residual = std::max(residual, first.residual_of(change));
      contacts = contacts.subspan(1);
      continue;
    }
    // On fixed ground A's state stays in registers from contact to contact. Through memory, the computation of a time
    // step is 3 % slower.
    const std::span<Contact> run = run_at_front(contacts);
    State state = place.state();
    const Moved kept = moved(state, place);
    for (Contact& contact : run) {
      const Change change = contact.wanted_change<true, kSomeShear>(kept, 1);
      contact.make<true>(change, kept);
      residual = std::max(residual, contact.residual_of(change));
    }
    place.delta = state.delta;
    place.arm_nms = state.arm_nms;
    place.belt_ns = state.belt_ns;
    place.load_ns = state.load_ns;
    contacts = contacts.subspan(run.size());
  }
  return residual;
}

btScalar Contact::solve(std::span<Contact> contacts, bool some_shear) {
  return some_shear ? solve_each<true>(contacts) : solve_each<false>(contacts);
}

template <bool kSomeShear>
btScalar Contact::share_each(std::span<Contact> contacts, SharedChanges& changes) {
  btScalar residual = 0;
  State none;
  changes.runs.clear();
  changes.between_moving.clear();
  while (!contacts.empty()) {
    Contact& first = contacts.front();
    const Moved place = first.in_place(none);
    if (!first.on_ground()) {
      const int sharing = std::max({first.a_.body->contact_count, first.b_.body ? first.b_.body->contact_count : 0, 1});
      const Change change = first.wanted_change<false, kSomeShear>(place, 1.0 / sharing);
      changes.between_moving.push_back({&first, change});
      residual = std::max(residual, first.residual_of(change) * sharing * sharing);
      contacts = contacts.subspan(1);
      continue;
    }
    // What all of a run change is summed up in registers.
    const std::span<Contact> run = run_at_front(contacts);
    const int sharing = std::max(first.a_.body->contact_count, 1);
    const btScalar share = 1.0 / sharing;
    State before = place.state(), sum;
    const Moved seen = moved(before, place), summed = moved(sum, place);
    btScalar largest = 0;
    for (Contact& contact : run) {
      const Change change = contact.wanted_change<true, kSomeShear>(seen, share);
      contact.make<true>(change, summed);
      largest = std::max(largest, contact.residual_of(change));
    }
    residual = std::max(residual, largest * sharing * sharing);
    changes.runs.push_back({&first, sum});
    contacts = contacts.subspan(run.size());
  }

  for (const SharedChanges::OfRun& run : changes.runs) {
    const Moved place = run.any->in_place(none);
    place.delta += run.sum.delta;
    place.arm_nms += run.sum.arm_nms;
    place.belt_ns += run.sum.belt_ns;
    place.load_ns += run.sum.load_ns;
  }
  for (const SharedChanges::BetweenMoving& of : changes.between_moving)
    of.contact->make<false>(of.change, of.contact->in_place(none));
  return residual;
}

btScalar Contact::share(std::span<Contact> contacts, bool some_shear, SharedChanges& changes) {
  return some_shear ? share_each<true>(contacts, changes) : share_each<false>(contacts, changes);
}

}  // namespace kenaf::physics
