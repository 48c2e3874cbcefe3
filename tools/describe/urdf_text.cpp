#include "tools/describe/urdf_text.hpp"

#include <fmt/format.h>

#include <numbers>

#include "tools/describe/xml_tree.hpp"

namespace kenaf::describe {
namespace {

using physics::Pose;

std::string xyz_text(const Eigen::Vector3d& v) {
  // + 0.0 makes 0 of -0
  return fmt::format("{} {} {}", v.x() + 0.0, v.y() + 0.0, v.z() + 0.0);
}

std::string origin_text(const Pose& X) {
  const Eigen::Vector3d rpy = physics::roll_pitch_yaw(X.q);
  const std::string turned = rpy.isZero(0) ? "" : fmt::format(" rpy=\"{}\"", xyz_text(rpy));
  return fmt::format("<origin xyz=\"{}\"{}/>", xyz_text(X.p), turned);
}

std::string inertial_text(const MassProperties& mass) {
  const Eigen::Matrix3d& I = mass.inertia_kgm2;
  return fmt::format(
      "    <inertial>\n      {}\n      <mass value=\"{}\"/>\n      <inertia ixx=\"{}\" ixy=\"{}\" ixz=\"{}\" "
      "iyy=\"{}\" "
      "iyz=\"{}\" izz=\"{}\"/>\n    </inertial>\n",
      origin_text({mass.p_ACm_m, Eigen::Quaterniond::Identity()}), mass.mass_kg, I(0, 0), I(0, 1) + 0.0, I(0, 2) + 0.0,
      I(1, 1), I(1, 2) + 0.0, I(2, 2));
}

std::string shape_text(const UrdfShape& shape, const char* element, const std::string& more) {
  return fmt::format("    <{0}>\n      {1}\n      <geometry>{2}</geometry>\n{3}    </{0}>\n", element,
                     origin_text(shape.X_LS), shape.geometry, more);
}

}  // namespace

UrdfShape box_shape(const Eigen::Vector3d& size_m, const Eigen::Vector3d& p_LS_m) {
  return {fmt::format("<box size=\"{}\"/>", xyz_text(size_m)), {p_LS_m, Eigen::Quaterniond::Identity()}};
}

UrdfShape cylinder_along_y(double radius_m, double width_m, const Eigen::Vector3d& p_LS_m) {
  return {fmt::format("<cylinder radius=\"{}\" length=\"{}\"/>", radius_m, width_m),
          {p_LS_m, physics::rotation_from({std::numbers::pi / 2, 0, 0})}};
}

std::string link_text(const std::string& name, const MassProperties& mass_in_L, const std::vector<UrdfShape>& shapes,
                      const std::string& material) {
  const std::string escaped = xml_escaped(name);
  if (mass_in_L.mass_kg == 0 && shapes.empty()) return fmt::format("  <link name=\"{}\"/>\n", escaped);
  std::string text = fmt::format("  <link name=\"{}\">\n", escaped);
  if (mass_in_L.mass_kg > 0) text += inertial_text(mass_in_L);
  for (const UrdfShape& shape : shapes) {
    text += shape_text(shape, "visual", fmt::format("      <material name=\"{}\"/>\n", material));
    text += shape_text(shape, "collision", "");
  }
  return text + "  </link>\n";
}

std::string fixed_joint(const std::string& parent, const std::string& child, const Pose& X_ParentChild) {
  return fmt::format(
      "  <joint name=\"{1}_joint\" type=\"fixed\">\n    <parent link=\"{0}\"/>\n    <child link=\"{1}\"/>\n    {2}\n"
      "  </joint>\n",
      xml_escaped(parent), xml_escaped(child), origin_text(X_ParentChild));
}

std::string turning_joint(const TurningJoint& joint) {
  const std::string range =
      joint.limited ? fmt::format("lower=\"{}\" upper=\"{}\" ", joint.lower_rad + 0.0, joint.upper_rad + 0.0) : "";
  return fmt::format(
      "  <joint name=\"{1}_joint\" type=\"{2}\">\n    <parent link=\"{0}\"/>\n    <child link=\"{1}\"/>\n    {3}\n"
      "    <axis xyz=\"{4}\"/>\n    <limit {5}effort=\"{6}\" velocity=\"{7}\"/>\n  </joint>\n",
      xml_escaped(joint.parent), xml_escaped(joint.child), joint.limited ? "revolute" : "continuous",
      origin_text({joint.p_ParentChild_m, Eigen::Quaterniond::Identity()}), xyz_text(joint.axis), range,
      joint.effort_nm, joint.velocity_radps);
}

std::string friction_text(const std::string& link, double along, double across, bool along_axle) {
  const std::string text = fmt::format("  <gazebo reference=\"{}\"><mu1>{}</mu1><mu2>{}</mu2>", xml_escaped(link),
                                       along_axle ? across : along, along_axle ? along : across);
  return text + (along_axle ? "<fdir1>0 0 1</fdir1>" : "") + "</gazebo>\n";
}

}  // namespace kenaf::describe
