#include "camera/robot_cameras.hpp"

#include <algorithm>

namespace kenaf::camera {

physics::Pose camera_pose(const RobotSnapshot& robot, const physics::CameraDescription& camera) {
  if (!camera.mission_package) return compose(robot.X_WB, camera.X_BC);
  const std::size_t package = *camera.mission_package;
  const std::vector<double>& links_rad = robot.mission_link_rad[package];
  const double pan_rad = links_rad[0], tilt_rad = links_rad.size() > 1 ? links_rad[1] : 0;
  const physics::Pose X_MC{Eigen::Vector3d::Zero(), physics::rotation_from({0, tilt_rad, pan_rad})};
  return compose(compose(robot.X_WB, robot.description->mission_packages[package].X_BM), X_MC);
}

View camera_view(const RobotSnapshot& robot, const physics::CameraDescription& camera, double field_of_view_rad) {
  const double angle_rad = std::clamp(field_of_view_rad, camera.min_field_of_view_rad, camera.max_field_of_view_rad);
  return {{camera.width, camera.height, angle_rad}, camera_pose(robot, camera)};
}

const physics::CameraDescription* find_camera(const physics::RobotDescription& robot, std::string_view name) {
  const auto found = std::ranges::find(robot.cameras, name, &physics::CameraDescription::name);
  return found == robot.cameras.end() ? nullptr : &*found;
}

}  // namespace kenaf::camera
