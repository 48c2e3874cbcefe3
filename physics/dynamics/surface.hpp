// Surface properties for the contact solver: friction, and the belt that runs over a surface.
#pragma once

#include <cstdint>
#include <vector>

#include "physics/contact_point.hpp"
#include "physics/dynamics/belt.hpp"

namespace kenaf::physics {

struct Surface {
  double friction_along = 1;
  double friction_across = 1;  // equal to `friction_along` without a belt
  Belt* belt = nullptr;        // null: the surface does not move in its body
  double axis_y = 1;           // the belt turns about (0, axis_y, 0) of its body, 1 or -1
  double lug_height_m = 0;
  double shear_deformation_m = 0;  // K of shear.hpp, of a belt
  double compliance_scale = 1;     // of the compliance of the ground under it
  double damping_scale = 1;
  TouchingPart part = TouchingPart::body;  // of a robot; nothing else has one
};

// Stored at btCollisionObject::getUserPointer().
struct Collider {
  std::vector<Surface> surfaces;  // of each child of a compound shape, or the only one
  std::uint32_t robot = 0;        // 0: none
};

}  // namespace kenaf::physics
