// Elements of a URDF as text. Numbers are as short as they can be without losing a bit.
//
// Thread safety: pure functions.
#pragma once

#include <string>
#include <vector>

#include "physics/pose.hpp"
#include "tools/describe/mass_properties.hpp"

namespace kenaf::describe {

struct UrdfShape {
  std::string geometry;  // <box .../>
  physics::Pose X_LS;
};

UrdfShape box_shape(const Eigen::Vector3d& size_m, const Eigen::Vector3d& p_LS_m);
UrdfShape cylinder_along_y(double radius_m, double width_m, const Eigen::Vector3d& p_LS_m);

// A link with its shapes both for collision and to be seen, of a material by name; without <inertial> if its mass is 0.
std::string link_text(const std::string& name, const MassProperties& mass_in_L, const std::vector<UrdfShape>& shapes,
                      const std::string& material);

std::string fixed_joint(const std::string& parent, const std::string& child, const physics::Pose& X_ParentChild);

struct TurningJoint {
  std::string parent, child;
  Eigen::Vector3d p_ParentChild_m, axis;
  double effort_nm, velocity_radps;
  bool limited;  // revolute, with the limits below; otherwise continuous
  double lower_rad = 0, upper_rad = 0;
};
std::string turning_joint(const TurningJoint& joint);

// <mu1> and <mu2> for Gazebo. `along_axle`: the first shape is a cylinder along the axle, which stays where it is as
// the wheel turns, so mu1 is that across.
std::string friction_text(const std::string& link, double along, double across, bool along_axle);

}  // namespace kenaf::describe
