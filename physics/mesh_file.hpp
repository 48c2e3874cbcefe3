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
  std::string submesh;   // only the meshes of this name, or below the node of this name; empty: all
  bool centred = false;  // moves the middle of the submesh's bounding box to the origin
};

struct MeshContent {
  TriangleSurface surface;
  std::size_t other_faces = 0;  // points and lines, left out
};

// The triangles of all of a file's nodes; polygons are cut into triangles. Nothing else is opened: neither materials
// nor pictures. A Collada file's <unit> scales, its <up_axis> does not turn (as in Gazebo). Throws DescriptionError
// with what is wrong, without a place: no mesh of that format, no such submesh, no triangles, more than
// `most_triangles` with points and lines, a polygon of more than 500 corners, a vertex that is not a number, Collada
// with <instance_node>, skins, animations, a document type or elements nested more than 100 deep.
MeshContent read_mesh(std::string_view bytes, MeshFormat format, const MeshPart& part, std::size_t most_triangles);

}  // namespace kenaf::physics
