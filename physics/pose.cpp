#include "physics/pose.hpp"

#include <algorithm>
#include <cmath>

namespace kenaf::physics {

Eigen::Vector3d roll_pitch_yaw(const Eigen::Quaterniond& q_WB) {
  const Eigen::Matrix3d R_WB = q_WB.toRotationMatrix();
  const double pitch = std::asin(std::clamp(-R_WB(2, 0), -1.0, 1.0));
  // Nose straight up or down: roll and yaw turn about the same axis, and all of the turn counts as yaw.
  if (std::hypot(R_WB(2, 1), R_WB(2, 2)) < 1e-9) return {0, pitch, std::atan2(-R_WB(0, 1), R_WB(1, 1))};
  return {std::atan2(R_WB(2, 1), R_WB(2, 2)), pitch, std::atan2(R_WB(1, 0), R_WB(0, 0))};
}

Eigen::Quaterniond rotation_from(const Eigen::Vector3d& rpy) {
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  return AngleAxisd(rpy.z(), Vector3d::UnitZ()) * AngleAxisd(rpy.y(), Vector3d::UnitY()) *
         AngleAxisd(rpy.x(), Vector3d::UnitX());
}

Eigen::Quaterniond leveling(const Eigen::Vector3d& gravity_W_mps2) {
  if (!(gravity_W_mps2.norm() > 0)) return Eigen::Quaterniond::Identity();
  // up_W is the last row of R_LW = R_y(pitch) R_x(roll), (-sin p, cos p sin r, cos p cos r): solve for r and p.
  const Eigen::Vector3d up_W = -gravity_W_mps2.normalized();
  if (up_W.x() == 0 && up_W.y() == 0 && up_W.z() > 0) return Eigen::Quaterniond::Identity();
  return rotation_from({std::atan2(up_W.y(), up_W.z()), std::asin(std::clamp(-up_W.x(), -1.0, 1.0)), 0});
}

Pose compose(const Pose& X_AB, const Pose& X_BC) {
  return {X_AB.p + X_AB.q * X_BC.p, X_AB.q * X_BC.q};
}

Pose inverse(const Pose& X_AB) {
  const Eigen::Quaterniond q_BA = X_AB.q.conjugate();
  return {-(q_BA * X_AB.p), q_BA};
}

}  // namespace kenaf::physics
