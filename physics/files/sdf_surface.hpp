// The SDF shapes that become triangles.
#pragma once

#include <sdf/Geometry.hh>

#include "physics/files/sdf_reader.hpp"
#include "physics/files/world_files.hpp"
#include "physics/triangle_surface.hpp"

namespace kenaf::physics {

// The surface of a <cylinder>, <sphere>, <capsule>, <ellipsoid>, <polyline>, <mesh> or <heightmap>, in the collision's
// frame, tidied; without triangles if the geometry is none of these. Parts that are left out are listed.
// Throws DescriptionError with file and line if a size is invalid, a file is missing or malformed, or the surface has
// more than `most_triangles`.
TriangleSurface read_surface(const SdfPlaces& places, const sdf::Geometry& geometry, WorldFiles& files,
                             std::size_t most_triangles);

}  // namespace kenaf::physics
