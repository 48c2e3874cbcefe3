// Which links of a URDF are wheels, casters, tracks and flippers, and which are the hull.
//
// Thread safety: pure functions, but for the meshes.
#pragma once

#include <string>
#include <vector>

#include "tools/describe/shape_bounds.hpp"
#include "tools/describe/urdf_model.hpp"

namespace kenaf::describe {

enum class Role { hull, wheel, caster, track, flipper };

// Regular expressions (ECMAScript, anywhere in a link's name, without regard to case); empty: as found.
struct RoleChoice {
  std::string wheels, tracks, flippers;
  std::string hull;  // only these links' shapes make the hull's box
};

struct Roles {
  std::vector<Role> of_link;  // for each link of the model
  // The topmost link of each; what is below it has its role too. Tracks list all links.
  std::vector<std::size_t> wheels, casters, flippers, tracks;
  std::vector<std::size_t> hull;  // those whose shapes make the box
};

// Roles, in this order:
// - flipper: named so or chosen, on a revolute or continuous joint about y; without a name, four that are alone at the
//   corners of a robot without wheels;
// - track: named so or chosen, and what turns on it by continuous joints;
// - caster: named so; a wheel within 10 mm of the middle of all wheels; a sphere there that is fixed and touches the
//   ground;
// - wheel: chosen; otherwise with a cylinder or sphere, or a mesh and a name, on a continuous joint about y.
// All else is hull. Throws DescriptionError that names link or joint: steered and mecanum wheels, tracks beside wheels,
// neither of both, or an expression that is none. `warnings` gets the joints that are taken for fixed.
Roles find_roles(const UrdfModel& model, const RoleChoice& choice, Meshes& meshes, std::vector<std::string>& warnings);

// The link and all below it.
std::vector<std::size_t> subtree(const UrdfModel& model, std::size_t link);

// Whether an axis is that of y, either way.
bool along_y(const Eigen::Vector3d& axis_F);

}  // namespace kenaf::describe
