// The hull of a URDF's robot, its frame B and its mass. Thread safety: pure functions, but for the meshes.
#pragma once

#include "tools/describe/running_gear.hpp"

namespace kenaf::describe {

struct UrdfBody {
  physics::Pose X_FB;      // axes as F's
  Eigen::Vector3d size_m;  // of the hull's box
  MassProperties mass;     // in B, of all but the flippers
};

// See from_urdf.hpp. Throws DescriptionError: no link of the hull has a shape that can be read; no link has a mass; all
// masses are on one line; the flippers' middle is further from the box's centre than 0.3 of its length.
UrdfBody find_body(const UrdfModel& model, const Roles& roles, const RunningGear& gear, Meshes& meshes,
                   std::vector<std::string>& warnings);

}  // namespace kenaf::describe
