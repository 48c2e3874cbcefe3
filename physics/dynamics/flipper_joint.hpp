// A hinge between a robot's body and a flipper, with a servo of limited speed and torque.
#pragma once

#include <algorithm>

#include "physics/dynamics/bullet.hpp"
#include "physics/dynamics/limited_drive.hpp"
#include "physics/robot_description.hpp"
#include "robot/command.hpp"

namespace kenaf::physics {

// The coupling between servo and arm: rigid, unless effects change it.
struct ServoCoupling {
  double lag_s = 0;     // of the angle that the servo follows
  double play_rad = 0;  // between both ends
  double compliance_radpnm = 0;
  bool rigid() const { return play_rad == 0 && compliance_radpnm == 0; }
};

// The angle is counted through full turns, so it is unambiguous for a flipper with more than half a turn of travel.
//
// With a rigid coupling, the servo's row moves the arm. Otherwise the servo has an angle of its own: it moves as
// commanded and drags the arm by a spring and a damper that engage at the end of the play. If the spring's torque would
// exceed the servo's, the servo gives way. With play the arm hangs at half of it on its heavy side and falls through
// when its weight passes over; the gear's teeth yield too, so play below some mrad acts as a compliance.
class FlipperJoint : public btTypedConstraint {
 public:
  // `X_AJ`, `X_BJ`: the joint's frame in the frames of the two bodies' centres of mass. They coincide at angle 0; a
  // positive angle turns B about -y of the joint's frame.
  FlipperJoint(btRigidBody& a, btRigidBody& b, const btTransform& X_AJ, const btTransform& X_BJ,
               const ServoCoupling& coupling);

  // Reads angle and speed from the bodies; call once after each step.
  void after_step(double time_step_s);
  // Sets the angle and clears the history.
  void restart(double angle_rad);
  // Sets it to rest, as after a teleport, which turns no servo: servo and arm stay as far apart as they are.
  void come_to_rest();
  // Sets the servo for the next step.
  void drive(const robot::JointCommand& command, const FlipperDescription& flipper,
             const FlipperServoDescription& motor, double time_step_s);
  // Instead of drive(): at the end of the next step the servo has this direction, regardless of its limits; it turns at
  // most at 10 rad/s. A rigid arm is there too; otherwise it follows through play and compliance.
  void prescribe(double angle_rad, double time_step_s);

  double angle_rad() const { return angle_rad_; }
  // On the servo's side of play and compliance, where its encoder sits.
  double servo_rad() const { return coupling_.rigid() ? angle_rad_ : servo_rad_; }
  double speed_radps() const { return speed_radps_; }
  double torque_nm(double time_step_s) const { return servo_impulse / time_step_s; }  // + lifts the tip
  // The servo's part of it, without the mechanical stop, which takes no current.
  double servo_nm(double time_step_s) const {
    return std::clamp(torque_nm(time_step_s), -servo_most_nm_, servo_most_nm_);
  }

  // Where the hinge is, and how far its two sides have drifted: the arm's pivot ahead of the body's, and the turn that
  // would align the body's axis with the arm's. In W; a positive angle turns the arm about axis_W.
  struct Hinge {
    btVector3 pivot_W, axis_W, apart_W, tilt_W;
  };
  Hinge hinge() const;

  // What the servo does in the next step. The solver leaves in it the limit that it was at.
  LimitedDrive servo;

  // No rows for Bullet's own solver.
  void getInfo1(btConstraintInfo1* info) override { info->m_numConstraintRows = info->nub = 0; }
  void getInfo2(btConstraintInfo2*) override {}
  void setParam(int, btScalar, int) override {}
  btScalar getParam(int, int) const override { return 0; }

  double servo_impulse = 0;  // N m s, of the last step, set by the solver; + lifts the tip

 private:
  void push_through(double servo_radps, double torque_nm, double time_step_s);
  btVector3 axis_W() const;  // about which a positive angle turns
  double raw_angle_rad() const;

  btTransform X_AJ_, X_BJ_;
  double angle_rad_ = 0, speed_radps_ = 0;
  ServoCoupling coupling_;
  double servo_most_nm_ = 0;
  double followed_rad_ = 0;                                      // the commanded angle after the lag
  double servo_rad_ = 0, servo_radps_ = 0, most_apart_rad_ = 0;  // unused if rigid
};

}  // namespace kenaf::physics
