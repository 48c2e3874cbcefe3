#include "physics/dynamics/flipper_joint.hpp"

#include <algorithm>
#include <cmath>

#include "robot/angles.hpp"

namespace kenaf::physics {
namespace {

constexpr double kServoGain_per_s = 30;     // of the position loop
constexpr double kEndStopTorque_nm = 1000;  // limit of the mechanical stop, if its servo is not stronger
constexpr double kEndStopGain_per_s = 20;
constexpr double kTeeth_radpnm = 1e-4;      // compliance of the gear's teeth, with play
constexpr double kSpringDamping_s = 0.005;  // damping of the coupling over its stiffness

}  // namespace

FlipperJoint::FlipperJoint(btRigidBody& a, btRigidBody& b, const btTransform& X_AJ, const btTransform& X_BJ,
                           const ServoCoupling& coupling)
    : btTypedConstraint(HINGE_CONSTRAINT_TYPE, a, b), X_AJ_(X_AJ), X_BJ_(X_BJ), coupling_(coupling) {}

btVector3 FlipperJoint::axis_W() const {
  return -(m_rbA.getCenterOfMassTransform().getBasis() * X_AJ_.getBasis().getColumn(1));
}

double FlipperJoint::raw_angle_rad() const {
  const btMatrix3x3 R_WA = m_rbA.getCenterOfMassTransform().getBasis() * X_AJ_.getBasis();
  const btVector3 out_W = m_rbB.getCenterOfMassTransform().getBasis() * X_BJ_.getBasis().getColumn(0);
  return std::atan2(R_WA.getColumn(2).dot(out_W), R_WA.getColumn(0).dot(out_W));
}

void FlipperJoint::after_step(double time_step_s) {
  angle_rad_ += robot::wrap_angle(raw_angle_rad() - angle_rad_);
  speed_radps_ = axis_W().dot(m_rbB.getAngularVelocity() - m_rbA.getAngularVelocity());
  if (!coupling_.rigid())
    servo_rad_ =
        std::clamp(servo_rad_ + time_step_s * servo_radps_, angle_rad_ - most_apart_rad_, angle_rad_ + most_apart_rad_);
}

void FlipperJoint::restart(double angle_rad) {
  angle_rad_ = followed_rad_ = servo_rad_ = angle_rad;
  come_to_rest();
}

void FlipperJoint::come_to_rest() {
  speed_radps_ = servo_radps_ = 0;
  servo_impulse = 0;
  servo.limit = LimitedDrive::Limit::none;
}

void FlipperJoint::drive(const robot::JointCommand& command, const FlipperDescription& flipper,
                         const FlipperServoDescription& motor, double time_step_s) {
  // Speed and torque limit by mode.
  double torque = motor.max_torque_nm;
  double speed = 0;
  const double at = servo_rad();
  if (command.mode != robot::JointMode::angle) followed_rad_ = at;
  switch (command.mode) {
    case robot::JointMode::angle: {
      double target = robot::reachable_angle(command.value, at, flipper.min_angle_rad, flipper.max_angle_rad);
      if (coupling_.lag_s > 0) {
        followed_rad_ -= std::expm1(-time_step_s / coupling_.lag_s) * (target - followed_rad_);
        target = followed_rad_;
      }
      speed = std::clamp(kServoGain_per_s * (target - at), -motor.max_speed_radps, motor.max_speed_radps);
      break;
    }
    case robot::JointMode::speed:
      speed = std::clamp(command.value, -motor.max_speed_radps, motor.max_speed_radps);
      break;
    case robot::JointMode::torque:  // runs freely up to the servo's speed
      torque = std::min(std::abs(command.value), motor.max_torque_nm);
      speed = std::copysign(motor.max_speed_radps, command.value);
      break;
    case robot::JointMode::brake:
    case robot::JointMode::keep:  // the command channel lets none pass
      break;
  }
  servo_most_nm_ = torque;
  servo.low = -torque * time_step_s;
  servo.high = torque * time_step_s;

  // Never past a limit within the next step; a load may press it past, then the stop pushes back.
  speed = std::clamp(speed, std::min((flipper.min_angle_rad - at) / time_step_s, 0.0),
                     std::max((flipper.max_angle_rad - at) / time_step_s, 0.0));
  if (!coupling_.rigid()) push_through(speed, torque, time_step_s);

  // Beyond a limit the stop acts, which is at the arm; otherwise a soft coupling has set its own row already.
  const double to_min = flipper.min_angle_rad - angle_rad_, to_max = flipper.max_angle_rad - angle_rad_;
  const double most_of_stop_nm = std::max(kEndStopTorque_nm, torque);
  if (to_max < 0 || to_min > 0) servo.softness = 0;  // the stop is rigid
  if (to_max < 0) {
    speed = std::min(speed, kEndStopGain_per_s * to_max);
    servo.low = -most_of_stop_nm * time_step_s;
  } else if (to_min > 0) {
    speed = std::max(speed, kEndStopGain_per_s * to_min);
    servo.high = most_of_stop_nm * time_step_s;
  } else if (servo.softness > 0) {
    return;
  }
  servo.target = speed;
}

void FlipperJoint::prescribe(double angle_rad, double time_step_s) {
  constexpr double kAnyTorque_nm = 1e6;
  constexpr double kFastest_radps = 10;  // chosen: an arm that starts elsewhere gets there without a shock
  const double at = servo_rad();
  servo.target = std::clamp(robot::wrap_angle(angle_rad - at) / time_step_s, -kFastest_radps, kFastest_radps);
  servo_most_nm_ = kAnyTorque_nm;
  servo.high = kAnyTorque_nm * time_step_s;
  servo.low = -servo.high;
  servo.softness = 0;
  followed_rad_ = at + servo.target * time_step_s;
  if (!coupling_.rigid()) push_through(servo.target, kAnyTorque_nm, time_step_s);
}

// Spring and damper, implicit as a contact's: torque = k (apart + h (servo - arm speed)) + d (servo - arm speed), at
// most the servo's, and with play never a pull across it. Solved for the arm's speed, with d = k kSpringDamping_s:
//   arm speed = servo speed + k apart / (k h + d) - impulse / (h (k h + d))
void FlipperJoint::push_through(double servo_radps, double torque_nm, double time_step_s) {
  const double give =
      coupling_.play_rad > 0 ? std::max(coupling_.compliance_radpnm, kTeeth_radpnm) : coupling_.compliance_radpnm;
  servo_radps_ = servo_radps;
  most_apart_rad_ = coupling_.play_rad / 2 + give * torque_nm;
  const double ahead = servo_rad_ - angle_rad_;
  const double stiffness = 1 / give;
  const double step_stiffness = stiffness * (time_step_s + kSpringDamping_s);
  servo.softness = 1 / (time_step_s * step_stiffness);
  servo.target = servo_radps + stiffness * (ahead - std::copysign(coupling_.play_rad / 2, ahead)) / step_stiffness;
  if (coupling_.play_rad > 0) (ahead < 0 ? servo.high : servo.low) = 0;
}

FlipperJoint::Hinge FlipperJoint::hinge() const {
  const btTransform &X_WA = m_rbA.getCenterOfMassTransform(), &X_WB = m_rbB.getCenterOfMassTransform();
  const btVector3 axis_a = axis_W(), y_b = X_WB.getBasis() * X_BJ_.getBasis().getColumn(1);
  const btVector3 pivot_W = X_WA * X_AJ_.getOrigin();
  return {pivot_W, axis_a, X_WB * X_BJ_.getOrigin() - pivot_W, y_b.cross(axis_a)};
}

}  // namespace kenaf::physics
