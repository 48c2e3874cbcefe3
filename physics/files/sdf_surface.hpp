// The SDF shapes that become triangles.
#pragma once

#include <sdf/Geometry.hh>

#include "physics/files/sdf_reader.hpp"
#include "physics/files/world_files.hpp"
#include "physics/triangle_surface.hpp"

namespace kenaf::physics {

// The surface of a <cylinder>, <sphere>, <capsule>, <ellipsoid>, <polyline>, <mesh> or <heightmap>, in the collision's
// frame, tidy; without triangles where the geometry is none of these. What is left out of it is listed.
// Throws DescriptionError with file and line: sizes that cannot be, a file that is missing or not what it must be, a
// surface of more than `most_triangles`.
TriangleSurface read_surface(const SdfPlaces& places, const sdf::Geometry& geometry, WorldFiles& files,
                             std::size_t most_triangles);

}  // namespace kenaf::physics
