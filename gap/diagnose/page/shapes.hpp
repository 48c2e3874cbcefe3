// The robot and the ground near it as plain faces, for small pictures of a moment.
//
// Thread safety: values and pure functions.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "physics/robot_dimensions.hpp"
#include "physics/world_description.hpp"

namespace kenaf::gap::diagnose {

enum class Material { hull, belt, flipper, eye, solid };

// A flat convex face; corners counterclockwise seen from outside.
struct Face {
  std::vector<Eigen::Vector3d> corners_m;
  Material material = Material::solid;
};

struct RobotFaces {
  std::vector<Face> fixed;              // in the body frame B
  std::vector<Face> flipper;            // in its own frame: x along the arm from the pivot, z up
  std::array<bool, 4> has_flipper{};    // front left, front right, rear left, rear right
  Eigen::Vector3d p_BPivot_m{0, 0, 0};  // of the front left one; the others are mirror images, the rear arms point back
};
RobotFaces faces_of(const physics::RobotDimensions& size);

// The faces in frame W. `angles_rad`: roll, pitch, yaw; `flippers_rad`: front left, front right, rear left, rear right,
// positive tip up.
std::vector<Face> faces_in_pose(const RobotFaces& robot, const Eigen::Vector3d& p_WB_m,
                                const Eigen::Vector3d& angles_rad, const std::array<double, 4>& flippers_rad);

// The fixed world within about `radius_m` of a place, at most `most` faces of meshes, nearest first: those of boxes
// and meshes, and squares of level ground (`ground`).
struct WorldFaces {
  std::vector<Face> solids;
  std::vector<Face> ground;
  bool is_whole = true;  // false: there were more than `most`
};
WorldFaces faces_near(const physics::WorldDescription& world, const Eigen::Vector3d& p_W_m, double radius_m,
                      std::size_t most);

}  // namespace kenaf::gap::diagnose
