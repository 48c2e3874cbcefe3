// Wheels, casters, tracks and flippers of a URDF, as a description has them: pairs of mirror images.
//
// Thread safety: pure functions, but for the meshes.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/describe/roles.hpp"

namespace kenaf::describe {

// A wheel or caster by itself.
struct Rolling {
  std::size_t link;
  Eigen::Vector3d p_FW_m;  // its centre
  double radius_m;
  std::optional<double> width_m;  // none: a sphere
};

// Two mirror images: the mean of both.
struct WheelPair {
  Rolling left, right;
  double x_m, half_gauge_m, z_m, radius_m;
  std::optional<double> width_m;
};

struct TrackPair {
  std::vector<std::size_t> left, right;  // links
  double x_m, half_gauge_m, z_m;         // of the centre
  double length_m, end_radius_m, width_m;
  bool radius_of_box;  // half of the height, for want of cylinders
};

// Four mirror images: the mean of all.
struct FlipperSet {
  std::vector<std::size_t> links;  // front left, front right, rear left, rear right
  double x_m, half_length_m;       // their middle, and half of what front and rear pivots are apart
  double half_gauge_m, z_m;
  double mass_kg, length_m, pivot_radius_m, tip_radius_m, width_m;
  double min_angle_rad, max_angle_rad;  // 0: straight out; positive: tip up
  bool limited;                         // false: continuous joints
  double effort_nm, velocity_radps;     // 0: not said
};

struct RunningGear {
  double y_m;                     // of the plane of symmetry in F
  std::vector<WheelPair> wheels;  // the front one first
  std::vector<Rolling> casters;
  std::optional<TrackPair> track;
  std::optional<FlipperSet> flippers;
};

// Throws DescriptionError that names the links at fault: a wheel without a shape or with one that does not lie along
// its axle, a link without its mirror image, two of which a number differs by more than the tolerance
// (mirror_images.hpp), and by how much; tracks shorter than high; flippers other than four. `warnings` gets what the
// mean of both hides.
RunningGear find_running_gear(const UrdfModel& model, const Roles& roles, Meshes& meshes, double tolerance_m,
                              std::vector<std::string>& warnings);

// Masses of some links together, in F.
MassProperties mass_of(const UrdfModel& model, const std::vector<std::size_t>& links);

}  // namespace kenaf::describe
