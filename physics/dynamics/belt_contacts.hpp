// Where a belt touches the ground: pure geometry, one function for each kind of ground.
//
// A belt is looked at in slices, planes across its axis: at both edges, and between them where the ground may end
// between. In a slice the belt is two discs and their tangents, and ground is a line or a polygon, so contacts are
// exact:
//  - where a side of the ground faces the belt: the lowest points of both discs, and points spread along the straight
//  run;
//  - where an edge of the ground crosses the slice: the edge, pressed into the belt;
//  - beside the belt's outline nothing drives: a side face meets ground like any other surface.
// All points that touch are given, at most a millimetre apart; so a track's load spreads over its length and width
// however the ground is made, and does not depend on how the robot came to stand there.
// Everything is in the belt's frame T. Thread safety: pure functions.
#pragma once

#include <cstdint>
#include <vector>

#include "physics/dynamics/belt_shape.hpp"

namespace kenaf::physics {

struct BeltTouch {
  btVector3 p_T;          // half way between belt and ground
  btVector3 normal_T;     // unit, out of the ground
  btScalar gap_m;         // negative: pressed in
  btScalar share;         // of a run's point: what of the contact's stiffness it stands for
  bool holds_lugs;        // an edge of the ground across the belt, or a corner, behind which lugs catch; not a face
  std::uint64_t feature;  // the same one from step to step
};

// Half space below the plane normal_T . p = offset.
void touch_plane(const BeltShape& belt, const btVector3& normal_T, btScalar offset, std::vector<BeltTouch>& out);

struct BoxInT {
  btMatrix3x3 axes;  // its columns are the box's axes
  btVector3 center, half;
};
void touch_box(const BeltShape& belt, const BoxInT& box, std::vector<BeltTouch>& out);

// A triangle of a surface. `edge_faces[i]`: the normal of the neighbour beyond the edge from corner i to corner i + 1,
// for the one of the two triangles that owns the edge, and only where the surface is convex there; otherwise nothing
// touches that edge.
struct TriangleInT {
  btVector3 corner[3], normal;
  bool owns_edge[3];
  btVector3 neighbour_normal[3];
  std::uint32_t index;
};
void touch_triangle(const BeltShape& belt, const TriangleInT& triangle, std::vector<BeltTouch>& out);

// A gap that a step may close.
inline constexpr btScalar kTouching_m = 0.001;

}  // namespace kenaf::physics
