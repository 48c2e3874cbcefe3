// Smoothed brightness of a mesh: curved surfaces look curved, and edges stay sharp.
//
// Thread safety: a pure function.
#pragma once

#include <array>
#include <vector>

#include "physics/world_description.hpp"

namespace kenaf::camera {

// For each corner of each triangle the cosine between `toward_sun_W` (unit) and the mean normal, weighted by area, of
// the triangles that meet there and are inclined to this one by less than 35 degrees; not below 0.
std::vector<std::array<float, 3>> mesh_facing(const physics::TriangleMesh& mesh, const Eigen::Vector3d& toward_sun_W);

}  // namespace kenaf::camera
