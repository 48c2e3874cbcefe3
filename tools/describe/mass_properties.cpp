#include "tools/describe/mass_properties.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>

namespace kenaf::describe {
namespace {

// The inertia that a point mass of 1 kg at d adds (parallel axis theorem).
Eigen::Matrix3d of_point(const Eigen::Vector3d& d) {
  return d.squaredNorm() * Eigen::Matrix3d::Identity() - d * d.transpose();
}

}  // namespace

MassProperties moved(const MassProperties& in_B, const physics::Pose& X_AB) {
  const Eigen::Matrix3d R_AB = X_AB.q.toRotationMatrix();
  return {in_B.mass_kg, X_AB.p + R_AB * in_B.p_ACm_m, R_AB * in_B.inertia_kgm2 * R_AB.transpose()};
}

MassProperties sum(const MassProperties& a, const MassProperties& b) {
  const double mass_kg = a.mass_kg + b.mass_kg;
  if (mass_kg == 0) return a;
  const Eigen::Vector3d p = (a.mass_kg * a.p_ACm_m + b.mass_kg * b.p_ACm_m) / mass_kg;
  return {mass_kg, p,
          a.inertia_kgm2 + a.mass_kg * of_point(a.p_ACm_m - p) + b.inertia_kgm2 + b.mass_kg * of_point(b.p_ACm_m - p)};
}

MassProperties difference(const MassProperties& whole, const MassProperties& part) {
  const double mass_kg = whole.mass_kg - part.mass_kg;
  const Eigen::Vector3d p = (whole.mass_kg * whole.p_ACm_m - part.mass_kg * part.p_ACm_m) / mass_kg;
  return {mass_kg, p,
          whole.inertia_kgm2 + whole.mass_kg * of_point(whole.p_ACm_m - p) - part.inertia_kgm2 -
              part.mass_kg * of_point(part.p_ACm_m - p)};
}

double moment_about(const MassProperties& mass, const Eigen::Vector3d& p_m, const Eigen::Vector3d& axis) {
  return axis.dot((mass.inertia_kgm2 + mass.mass_kg * of_point(mass.p_ACm_m - p_m)) * axis);
}

std::string inertia_fault(const Eigen::Matrix3d& inertia_kgm2) {
  constexpr double kRounded = 1e-3;  // chosen: files give three digits
  const Eigen::Vector3d principal =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(inertia_kgm2, Eigen::EigenvaluesOnly).eigenvalues();
  const std::string moments = fmt::format("its principal moments are {:.4g}, {:.4g} and {:.4g} kg m2", principal[0],
                                          principal[1], principal[2]);
  if (!(principal[0] > 0)) return moments + ", of which none may be 0 or less";
  if (principal[2] > (principal[0] + principal[1]) * (1 + kRounded))
    return moments + ", of which none may be larger than the sum of the two others";
  return {};
}

Eigen::Matrix3d cylinder_inertia(double mass_kg, double radius_m, double width_m) {
  const double across = mass_kg * (3 * radius_m * radius_m + width_m * width_m) / 12;
  return Eigen::Vector3d(across, mass_kg * radius_m * radius_m / 2, across).asDiagonal();
}

}  // namespace kenaf::describe
