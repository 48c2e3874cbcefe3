// The SDF shapes that become triangles.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <tuple>

#include "physics/files/sdf_element.hpp"
#include "physics/files/sdf_notes.hpp"
#include "physics/files/world_files.hpp"
#include "physics/height_map.hpp"
#include "physics/mesh_file.hpp"
#include "physics/triangle_surface.hpp"

namespace kenaf::physics {

// What was read of a world's files, once for all shapes that use it.
struct ShapeFiles {
  WorldFiles& files;
  std::map<std::tuple<std::filesystem::path, std::string, bool>, MeshContent> meshes{};  // by file and MeshPart
  std::map<std::filesystem::path, GreyPicture> pictures{};
};

// The surface of a <cylinder>, <sphere>, <capsule>, <ellipsoid>, <polyline>, <mesh> or <heightmap>, in the collision's
// frame, tidied. Parts that are left out are noted.
// Throws DescriptionError with file and line if a size is invalid, a file is missing or malformed, or the surface has
// more than `most_triangles`.
TriangleSurface read_surface(SdfNotes& notes, const SdfElement& shape, ShapeFiles& files, std::size_t most_triangles);

}  // namespace kenaf::physics
