// Where a belt touches the ground: pure geometry, one function for each kind of ground.
//
// A belt is examined in slices, planes across its axis: at both edges, and between them where the ground may end there.
// In a slice the belt is two discs and their tangents, and the ground is a line or a polygon, so contacts are exact:
//  - a face of the ground touches the lowest points of both discs and points along the straight run that faces it;
//  - an edge of the ground that crosses the slice touches the outline;
//  - beside the outline nothing drives: a side face meets the ground like any other surface.
// All points that are pressed into the ground or within 1 mm of it are returned. So a track's load spreads over its
// length and width whatever the ground consists of, and does not depend on how the robot came to stand there.
// Everything is in the belt's frame T. Thread safety: pure functions.
#pragma once

#include <cstdint>
#include <vector>

#include "physics/dynamics/belt_shape.hpp"

namespace kenaf::physics {

struct BeltTouch {
  btVector3 p_T;       // half way between belt and ground
  btVector3 normal_T;  // unit, out of the ground
  btScalar gap_m;      // negative: pressed in
  btScalar weight;     // factor of stiffness and damping; grows with the area that the point stands for
  bool holds_lugs;     // lugs catch behind it: an edge of the ground across the belt, or a corner; not a face
  // Its place along the straight run that faces the ground, in pieces from disc 0, 0 to BeltShape::pieces; -1: it is on
  // no such run, but on an arc, an edge, a corner, a side face or a wheel.
  int run_place;
  std::uint64_t feature;  // identifies the contact from step to step
};

// Half space below the plane normal_T . p = offset.
void touch_plane(const BeltShape& belt, const btVector3& normal_T, btScalar offset, std::vector<BeltTouch>& out);

struct BoxInT {
  btMatrix3x3 axes;  // its columns are the box's axes
  btVector3 center, half;
};
void touch_box(const BeltShape& belt, const BoxInT& box, std::vector<BeltTouch>& out);

// A triangle of a surface. Edge i runs from corner i to corner i + 1; `neighbour_normal[i]` is the normal of the
// triangle beyond it. One of the two triangles owns the edge, and only where the surface is convex there; an edge that
// nobody owns touches nothing.
struct TriangleInT {
  btVector3 corner[3], normal;
  bool owns_edge[3];
  btVector3 neighbour_normal[3];
  std::uint32_t index;
  bool at_ridge = false;  // a convex edge of it is sharp: it may be of a pole or a pipe that lies between two slices
};
void touch_triangle(const BeltShape& belt, const TriangleInT& triangle, std::vector<BeltTouch>& out);

}  // namespace kenaf::physics
