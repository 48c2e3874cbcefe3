// Triangles in a frame of their own: a mesh file, a height map or a shape before it is placed in a world.
// SI units. Thread safety: values and pure functions.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace kenaf::physics {

struct TriangleSurface {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;  // counter-clockwise as seen from outside
};

struct TidySurface {
  std::size_t dropped = 0;     // triangles without area
  bool closed = false;         // every edge has a triangle on either side
  bool windings_agree = true;  // no two neighbours take the same edge in the same direction
};

// Returns for each vertex the index of one that stands for all vertices at exactly the same place (-0 is 0): two are at
// the same place if and only if their numbers are equal. The vertices must be finite.
std::vector<std::uint32_t> places_of(std::span<const Eigen::Vector3d> vertices);

// Joins vertices at the same place, drops triangles without area (thinner than 1 um), and turns the triangles of a
// closed surface so that their normals point outward. The vertices must be finite, the indices within range.
TidySurface tidy(TriangleSurface& surface);

// Returns the signed volume that a closed surface encloses, positive if its normals point outward.
double volume_m3(const TriangleSurface& surface);

}  // namespace kenaf::physics
