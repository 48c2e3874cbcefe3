// Masses of rigid bodies: moved, added, taken apart.
//
// Thread safety: values and pure functions.
#pragma once

#include <Eigen/Core>
#include <string>

#include "physics/pose.hpp"

namespace kenaf::describe {

// Mass, centre of mass and inertia of a body, in some frame A.
struct MassProperties {
  double mass_kg = 0;
  Eigen::Vector3d p_ACm_m{Eigen::Vector3d::Zero()};
  Eigen::Matrix3d inertia_kgm2{Eigen::Matrix3d::Zero()};  // about the centre of mass, along A's axes
};

// The same in frame A, given in B.
MassProperties moved(const MassProperties& in_B, const physics::Pose& X_AB);

// Both in one frame: of the two together (parallel axis theorem), and of what is left of `whole` without `part`, whose
// mass must be smaller.
MassProperties sum(const MassProperties& a, const MassProperties& b);
MassProperties difference(const MassProperties& whole, const MassProperties& part);

// About an axis through point p_m along `axis`, which has length 1.
double moment_about(const MassProperties& mass, const Eigen::Vector3d& p_m, const Eigen::Vector3d& axis);

// Why no rigid body has this inertia, with its principal moments: one is not positive, or larger than the sum of the
// two others. Empty if one has.
std::string inertia_fault(const Eigen::Matrix3d& inertia_kgm2);

// A solid cylinder along y about its middle.
Eigen::Matrix3d cylinder_inertia(double mass_kg, double radius_m, double width_m);

}  // namespace kenaf::describe
