// A rigid pose and its roll, pitch, yaw. Body frames: x forward, y left, z up; world frames: z up (REP 103).
//
// Thread safety: values and pure functions.
#pragma once

#include <Eigen/Geometry>

namespace kenaf::physics {

// X_AB: where frame B is in frame A.
struct Pose {
  Eigen::Vector3d p{Eigen::Vector3d::Zero()};
  Eigen::Quaterniond q{Eigen::Quaterniond::Identity()};

  bool operator==(const Pose& other) const { return p == other.p && q.coeffs() == other.q.coeffs(); }
};

// Intrinsic z-y-x angles (roll, pitch, yaw); pitch positive nose down; each in (-pi, pi].
Eigen::Vector3d roll_pitch_yaw(const Eigen::Quaterniond& q_WB);
Eigen::Quaterniond rotation_from(const Eigen::Vector3d& roll_pitch_yaw);
// q_LW into axes L in which gravity points along -z, without a turn about z. The identity where it does so in W, or is
// 0.
Eigen::Quaterniond leveling(const Eigen::Vector3d& gravity_W_mps2);

// X_AC = compose(X_AB, X_BC)
Pose compose(const Pose& X_AB, const Pose& X_BC);
Pose inverse(const Pose& X_AB);

}  // namespace kenaf::physics
