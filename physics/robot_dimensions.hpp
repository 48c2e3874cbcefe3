// The part of a robot's description that a picture of it needs. SI units, radians, body frame B.
//
// Thread safety: values and a pure function.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <functional>
#include <vector>

#include "physics/robot_description.hpp"

namespace kenaf::physics {

// A track or a wheel, whose length is twice its radius.
struct BeltDimensions {
  double length_m, radius_m, width_m;
  Eigen::Vector3d p_B_m;  // its centre
};

// Dimensions of a robot, and limits of its drives.
struct RobotDimensions {
  Eigen::Vector3d body_size_m{0, 0, 0};
  std::vector<BeltDimensions> tracks;  // of the left side, the front one first; the right ones are mirror images
  std::vector<BeltDimensions> casters;
  double ride_height_m = 0;  // of B's origin on flat ground
  std::array<bool, robot::kFlipperCount> has_flipper{};
  bool has_flippers() const { return std::ranges::any_of(has_flipper, std::identity{}); }
  double flipper_length_m = 0, pivot_radius_m = 0, tip_radius_m = 0, flipper_width_m = 0;
  Eigen::Vector3d p_BPivot_m{0, 0, 0};  // of the front left flipper; the others are mirror images
  double min_angle_rad = 0, max_angle_rad = 0;
  double max_speed_mps = 0, max_flipper_radps = 0;
};
RobotDimensions dimensions_of(const RobotDescription& description);

}  // namespace kenaf::physics
