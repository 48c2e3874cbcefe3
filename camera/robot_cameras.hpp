// Poses and views of a robot's cameras, which its description lists ([[camera]]).
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

// The view with the zoomed field of view, clamped to the camera's limits.
View camera_view(const RobotSnapshot& robot, const physics::CameraDescription& camera, double field_of_view_rad);

// The camera of that name, null if the robot has none.
const physics::CameraDescription* find_camera(const physics::RobotDescription& robot, std::string_view name);

}  // namespace kenaf::camera
