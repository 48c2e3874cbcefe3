// A robot's description of a URDF.
//
// Thread safety: as urdf_model.hpp, one thread at a time.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tools/describe/roles.hpp"

namespace kenaf::describe {

struct FromUrdfOptions {
  RoleChoice choice;
  MeshFolders folders;
  double tolerance_m = 0.5e-3;   // by which mirror images may differ; see mirror_images.hpp
  std::string usarsim_class;     // empty: "USARBot." and the robot's name
  std::vector<std::string> set;  // "drive.max_force_n=300"; see set_value()
};

struct MadeDescription {
  std::string toml;                   // parse_robot() takes it
  std::vector<std::string> chosen;    // keys that the URDF does not say; see chosen_keys()
  std::vector<std::string> warnings;  // what was left out or made even
};

// - The hull's box is that of the collision shapes of all links that are neither wheels, casters, tracks nor flippers.
//   B's axes are F's (urdf_model.hpp). B's origin is the box's centre in x and z, and the middle of wheels or tracks in
//   y; with flippers, their middle in x.
// - [body] has the masses of all links but the flippers, at the joints' position 0. Products of inertia are left out.
// - Of a wheel's joint: max_speed_mps is the slowest wheel's velocity limit times its radius, max_force_n the sum of a
//   side's effort limits over the radius, moving_mass_kg the wheels' inertia about their axles as felt at the rim.
// - <mu1> and <mu2> for Gazebo are friction; <sensor> for Gazebo are sensors.
//
// Throws DescriptionError that names what cannot be and what to do: see urdf_model.hpp, roles.hpp and running_gear.hpp;
// no hull; no mass; a file that would not load, as with a wrong value in `set`.
MadeDescription from_urdf(std::string_view xml, const std::string& file, const FromUrdfOptions& options);

}  // namespace kenaf::describe
