// A hinge between a robot's body and a flipper, with a servo that is limited in speed and torque.
#pragma once

#include <array>

#include "physics/bullet.hpp"
#include "physics/robot_command.hpp"
#include "physics/robot_description.hpp"

namespace kenaf::physics {

// The angle is counted through full turns, so a flipper with more than half a turn of travel knows where it is.
class FlipperJoint : public btTypedConstraint {
 public:
  // `X_AJ`, `X_BJ`: the joint's frame in the frames of the two bodies' centres of mass. They coincide at angle 0; a
  // positive angle turns B about -y of the joint's frame.
  FlipperJoint(btRigidBody& a, btRigidBody& b, const btTransform& X_AJ, const btTransform& X_BJ);

  // Reads the angle from the bodies; call once after each step.
  void measure();
  // Places it without history, as after a teleport.
  void restart(double angle_rad);
  // Sets the servo for the next step.
  void drive(const JointCommand& command, const FlipperDescription& flipper, const FlipperServoDescription& servo,
             double time_step_s);

  double angle_rad() const { return angle_rad_; }
  double speed_radps() const;
  double torque_nm(double time_step_s) const { return row_impulse[5] / time_step_s; }  // + lifts the tip

  void getInfo1(btConstraintInfo1* info) override;
  void getInfo2(btConstraintInfo2* info) override;
  void setParam(int, btScalar, int) override {}
  btScalar getParam(int, int) const override { return 0; }

  std::array<double, 6> row_impulse{};  // of the last step; the servo's is the last one

 private:
  btVector3 axis_W() const;  // about which a positive angle turns
  double raw_angle_rad() const;

  btTransform X_AJ_, X_BJ_;
  double angle_rad_ = 0;
  double target_radps_ = 0, min_impulse_ = 0, max_impulse_ = 0;
};

}  // namespace kenaf::physics
