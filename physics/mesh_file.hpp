// A mesh file, read by assimp from memory.
//
// Thread safety: a pure function.
#pragma once

#include <string>
#include <string_view>

#include "physics/triangle_surface.hpp"

namespace kenaf::physics {

enum class MeshFormat { stl, obj, dae };

struct MeshPart {
  std::string submesh;   // only meshes of this name, or below a node of this name; empty: all
  bool centred = false;  // moves the middle of the submesh's bounding box to the origin
};

struct MeshContent {
  TriangleSurface surface;
  std::size_t other_faces = 0;  // points and lines, left out
};

// Returns the triangles of all nodes of a file; polygons are triangulated. No other file is opened, neither materials
// nor pictures. A Collada file's <unit> scales, its <up_axis> is ignored (as in Gazebo). Throws DescriptionError, which
// says what is wrong but not where: no mesh of that format, no such submesh, no triangles, more than `most_triangles`
// including points and lines, a polygon of more than 500 corners, a vertex that is not finite, or Collada with
// <instance_node>, skins, animations, a document type or elements nested more than 100 deep.
MeshContent read_mesh(std::string_view bytes, MeshFormat format, const MeshPart& part, std::size_t most_triangles);

}  // namespace kenaf::physics
