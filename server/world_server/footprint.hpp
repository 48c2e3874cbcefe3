// The ground that a robot covers.
//
// Thread safety: pure functions.
#pragma once

#include <Eigen/Core>

#include "physics/pose.hpp"
#include "physics/robot_description.hpp"

namespace kenaf::world_server {

// A box about the origin of B: hull and tracks or wheels, without flippers, which may be raised. Half of its size, m.
Eigen::Vector3d half_footprint_m(const physics::RobotDescription& robot);

// Whether two such boxes overlap, upright but for their headings.
bool footprints_overlap(const physics::Pose& X_WA, const Eigen::Vector3d& half_a_m, const physics::Pose& X_WB,
                        const Eigen::Vector3d& half_b_m);

}  // namespace kenaf::world_server
