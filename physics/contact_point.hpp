// Where a robot touches something, and the force on it there.
//
// Thread safety: values.
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace kenaf::physics {

// What of a robot touches. A side's wheels count as its track; a caster is a wheel that nothing drives.
enum class TouchingPart : std::uint8_t {
  left_track,
  right_track,
  front_left_flipper,
  front_right_flipper,
  rear_left_flipper,
  rear_right_flipper,
  caster,
  body
};

// A point where a robot is pressed upon by ground, a box or another robot.
struct ContactPoint {
  Eigen::Vector3d p_W;
  Eigen::Vector3d force_W_n;  // on the robot: pressure and friction together
  TouchingPart part;
};

}  // namespace kenaf::physics
