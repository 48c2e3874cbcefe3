// Where a robot's cameras are, and what they see by. Which there are stands in its description ([[camera]]).
//
// Thread safety: pure functions.
#pragma once

#include <string_view>

#include "camera/lens.hpp"
#include "camera/snapshot.hpp"

namespace kenaf::camera {

// A camera fixed on the body is at its mount. One on a mission package is at the package's mount, turned by link 1
// about the mount's z (pan; positive: to the left), then by link 2, if there is one, about y (tilt; positive: down, as
// pitch).
physics::Pose camera_pose(const RobotSnapshot& robot, const physics::CameraDescription& camera);

// With the field of view as zoomed: clamped to what the camera can.
View camera_view(const RobotSnapshot& robot, const physics::CameraDescription& camera, double field_of_view_rad);

// The camera of that name; null: the robot has none.
const physics::CameraDescription* find_camera(const physics::RobotDescription& robot, std::string_view name);

}  // namespace kenaf::camera
