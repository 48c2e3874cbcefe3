// The surface of a part of the scene: triangles, grouped into plane faces that carry a texture.
//
// Everything else works on faces: two rays that hit the same face hit the same plane, whatever the triangles are. Part
// frame L, metres. Thread safety: values and pure functions.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "physics/robot_description.hpp"

namespace kenaf::camera {

enum class Material : std::uint8_t {
  ground,
  terrain,
  fixed_box,
  loose_box,
  hull,
  belt,
  track_side,
  front_flipper,
  rear_flipper,
  drum
};
inline constexpr std::size_t kMaterialCount = 10;

// An affine function of a point: gradient . p + offset.
struct Affine {
  Eigen::Vector3d gradient{0, 0, 0};
  double offset = 0;
  double operator()(const Eigen::Vector3d& p) const { return gradient.dot(p) + offset; }
};

// A plane face. Its texture has the coordinates s and t, each with a period of 1.
struct Face {
  Eigen::Vector3d normal;  // unit, outward
  double distance;         // normal . p of its points
  Affine s, t;
  Material material;
  Eigen::Vector2d half{0, 0};  // of a box: |s| and |t| at its edges, which are drawn; 0: no edges
  double s_per_track_m = 0;    // change of s per metre of travel of `track`'s belt
  robot::Track track = robot::kLeft;
};

struct Surface {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint32_t> face_of_triangle;
  std::vector<Face> faces;
};

// Adds a box around the pose. s and t of each face are metres from its middle; the texture's period is 1 m.
void add_box(Surface& surface, const Eigen::Vector3d& size_m, const physics::Pose& X_LBox, Material material);

// The rigid parts of a robot: B with hull and both main tracks, and an arm, whose frame is at its pivot, x out along
// the arm. Outlines are the physics' own (physics/robot_shapes.hpp). Belts show a lug every 30 mm, which moves with the
// track's travel, and wheels protrude 2 mm from the sides so that ends and middle are distinguishable: both are
// decoration, no description has them.
Surface body_surface(const physics::RobotDescription& robot);
Surface flipper_surface(const physics::RobotDescription& robot, robot::Flipper which);

// Returns the pose of a flipper's arm in B; 0: straight out along the body, positive: tip up.
physics::Pose flipper_pose(const physics::RobotDescription& robot, robot::Flipper which, double angle_rad);

}  // namespace kenaf::camera
