// The part of a robot's description that a picture of it needs. SI units, radians, body frame B.
//
// Thread safety: values and a pure function.
#pragma once

#include <Eigen/Core>

#include "physics/robot_description.hpp"

namespace kenaf::physics {

// Dimensions of a robot, and limits of its drives.
struct RobotDimensions {
  Eigen::Vector3d body_size_m{0, 0, 0};
  double track_length_m = 0, track_radius_m = 0, track_width_m = 0;
  Eigen::Vector3d p_BT_m{0, 0, 0};  // centre of the left track; the right one is its mirror image
  bool has_flippers = false;
  double flipper_length_m = 0, pivot_radius_m = 0, tip_radius_m = 0, flipper_width_m = 0;
  Eigen::Vector3d p_BPivot_m{0, 0, 0};  // of the front left flipper; the others are mirror images
  double min_angle_rad = 0, max_angle_rad = 0;
  double max_speed_mps = 0, max_flipper_radps = 0;
};
RobotDimensions dimensions_of(const RobotDescription& description);

}  // namespace kenaf::physics
