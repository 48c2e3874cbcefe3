#include "physics/dynamics/articulated_body.hpp"

#include <cmath>

namespace kenaf::physics {
namespace {

struct FreeVelocity {
  btVector3 v, w;
};

// What the gyroscopic moment changes of a body's angular velocity, in W: one Newton step of I w' = h w' x I w' from w,
// in the body's axes, where I is diagonal; as btRigidBody::computeGyroscopicImpulseImplicit_Body does it with
// quaternions in three times the time.
btVector3 gyroscopic_turn(const btRigidBody& body, btScalar h) {
  const btMatrix3x3& R = body.getWorldTransform().getBasis();
  const btVector3 I = body.getLocalInertia();
  const btVector3 w = body.getAngularVelocity() * R, L = I * w;
  const btMatrix3x3 jacobian(I.x(), h * (L.z() - w.z() * I.y()), h * (w.y() * I.z() - L.y()),
                             h * (w.z() * I.x() - L.z()), I.y(), h * (L.x() - w.x() * I.z()),
                             h * (L.y() - w.y() * I.x()), h * (w.x() * I.y() - L.x()), I.z());
  return R * -jacobian.solve33(h * w.cross(L));
}

// At the end of a step in which nothing but gravity and the gyroscopic moment acts on the body.
FreeVelocity free_velocity(const btRigidBody& body, btScalar time_step) {
  return {body.getLinearVelocity() + body.getTotalForce() * body.getInvMass() * time_step,
          body.getAngularVelocity() + gyroscopic_turn(body, time_step)};
}

btMatrix3x3 inertia_W(const btRigidBody& body) {
  const btMatrix3x3& R = body.getWorldTransform().getBasis();
  const btVector3& inverse = body.getInvInertiaDiagLocal();
  return R.scaled(btVector3(1 / inverse.x(), 1 / inverse.y(), 1 / inverse.z())) * R.transpose();
}

// Of a point mass at r: m (r . r - r r^T).
btMatrix3x3 point_inertia(btScalar mass, const btVector3& r) {
  const btScalar xx = r.x() * r.x(), yy = r.y() * r.y(), zz = r.z() * r.z();
  const btScalar xy = -r.x() * r.y(), xz = -r.x() * r.z(), yz = -r.y() * r.z();
  return btMatrix3x3(yy + zz, xy, xz, xy, xx + zz, yz, xz, yz, xx + yy) * mass;
}

TwoVectors velocity_at_C(const ArticulatedBody& body) {
  return side_by_side(body.v, body.w) + body.delta;
}

btScalar rate_now(const ArticulatedBody& body, const Arm& arm) {
  return arm.rate + arm.mobility * (arm.push_nms - sum_of_lanes(dot(arm.coupling, body.delta)));
}

btScalar impulse_to_hold(const ArticulatedBody& body, const Arm& arm) {
  return arm.inertia * arm.joint->servo.target + sum_of_lanes(dot(arm.coupling, velocity_at_C(body))) - arm.momentum -
         arm.push_nms;
}

}  // namespace

ArticulatedBody to_solver(btRigidBody& base, std::span<Arm> arms, btScalar time_step, btScalar correction_per_s) {
  ArticulatedBody body{};
  body.base = &base;
  body.arms = arms;
  const FreeVelocity of_base = free_velocity(base, time_step);
  const btVector3& p_base = base.getWorldTransform().getOrigin();
  if (arms.empty()) {
    body.v = of_base.v;
    body.w = of_base.w;
    body.p_WC = p_base;
    body.inverse_mass = base.getInvMass();
    body.inverse_inertia_W = base.getInvInertiaTensorWorld();
    return body;
  }

  // Mass, and where C is.
  const btScalar base_mass = 1 / base.getInvMass();
  btScalar mass = base_mass;
  btVector3 moment = p_base * base_mass;
  for (const Arm& arm : arms) {
    const btScalar arm_mass = 1 / arm.body->getInvMass();
    mass += arm_mass;
    moment += arm.body->getWorldTransform().getOrigin() * arm_mass;
  }
  body.p_WC = moment / mass;
  body.inverse_mass = 1 / mass;

  // Momenta and moments of inertia of base and arms, about C.
  const btVector3 r_base = p_base - body.p_WC;
  const btMatrix3x3 base_inertia = inertia_W(base);
  btMatrix3x3 inertia = base_inertia + point_inertia(base_mass, r_base);
  btVector3 linear = of_base.v * base_mass, angular = base_inertia * of_base.w + r_base.cross(linear);
  for (Arm& arm : arms) {
    const FlipperJoint::Hinge hinge = arm.joint->hinge();
    arm.pivot_W = hinge.pivot_W;
    arm.axis_W = hinge.axis_W;
    arm.bias_v = -correction_per_s * hinge.apart_W;
    arm.bias_w = -correction_per_s * hinge.tilt_W;

    // The arm's motion relative to what the hinge adds to the base's.
    const btScalar arm_mass = 1 / arm.body->getInvMass();
    const btVector3& p_arm = arm.body->getWorldTransform().getOrigin();
    const btVector3 from_pivot = p_arm - arm.pivot_W, r = p_arm - body.p_WC;
    const FreeVelocity free = free_velocity(*arm.body, time_step);
    const btMatrix3x3 arm_inertia = inertia_W(*arm.body);
    const btVector3 p = (free.v - arm.bias_v - arm.bias_w.cross(from_pivot)) * arm_mass;
    const btVector3 spin = arm_inertia * (free.w - arm.bias_w);
    linear += p;
    angular += spin + r.cross(p);
    inertia += arm_inertia + point_inertia(arm_mass, r);

    // For a rate of 1 its momentum: linear m s x r, and about C.
    const btVector3 sweep = arm.axis_W.cross(from_pivot), swept = sweep * arm_mass, turned = arm_inertia * arm.axis_W;
    arm.coupling = side_by_side(swept, turned + r.cross(swept));
    arm.inertia = swept.dot(sweep) + turned.dot(arm.axis_W);
    arm.momentum = sweep.dot(p) + arm.axis_W.dot(spin);
  }
  body.inverse_inertia_W = inertia.inverse();
  body.momentum = side_by_side(linear, angular);
  begin_anew(body);
  return body;
}

void begin_anew(ArticulatedBody& body) {
  body.delta = TwoVectors{};
  if (body.arms.empty()) return;
  body.loose_count = 0;
  TwoVectors rest = body.momentum;  // of the base, with the arms' rates taken out
  std::array<btScalar, robot::kFlipperCount> right_side{};
  for (std::size_t j = 0; j < body.arms.size(); ++j) {
    Arm& arm = body.arms[j];
    arm.push_nms = 0;
    arm.mobility = 0;
    arm.rate = arm.joint->servo.target;
    if (!arm.joint->servo.holds()) {
      const YieldingDrive servo = yielding(arm.joint->servo);
      arm.mobility = 1 / (arm.inertia + servo.inertia);
      right_side[j] = arm.momentum + servo.momentum;
      arm.rate = arm.mobility * right_side[j];
      const TwoVectors moved = body.response(arm.coupling);
      const btScalar left = 1 / arm.mobility - sum_of_lanes(dot(arm.coupling, moved));
      body.loose[body.loose_count++] = moved * (1 / std::sqrt(left));
    }
    rest -= arm.coupling * arm.rate;
  }
  const TwoVectors velocity = body.response(rest);
  body.v = vector_of(velocity, 0);
  body.w = vector_of(velocity, 1);
  for (Arm& arm : body.arms) arm.rate -= arm.mobility * sum_of_lanes(dot(arm.coupling, velocity));
}

bool settle_servos(ArticulatedBody& body) {
  bool changed = false;
  for (const Arm& arm : body.arms) changed |= settle(arm.joint->servo, rate_now(body, arm), impulse_to_hold(body, arm));
  return changed;
}

void write_back(const ArticulatedBody& solved) {
  const TwoVectors velocity = velocity_at_C(solved);
  const btVector3 v_C = vector_of(velocity, 0), w = vector_of(velocity, 1);
  const auto v_at = [&](const btVector3& p_W) { return v_C + w.cross(p_W - solved.p_WC); };
  solved.base->setLinearVelocity(v_at(solved.base->getWorldTransform().getOrigin()));
  solved.base->setAngularVelocity(w);
  for (const Arm& arm : solved.arms) {
    const btVector3 from_base = arm.bias_w + arm.axis_W * rate_now(solved, arm);
    const btVector3& p_W = arm.body->getWorldTransform().getOrigin();
    arm.body->setLinearVelocity(v_at(p_W) + arm.bias_v + from_base.cross(p_W - arm.pivot_W));
    arm.body->setAngularVelocity(w + from_base);
    arm.joint->servo_impulse = given_impulse(arm.joint->servo, rate_now(solved, arm), impulse_to_hold(solved, arm));
  }
}

}  // namespace kenaf::physics
