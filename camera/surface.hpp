// What a part of the scene looks like from outside: triangles, gathered into plane faces that carry a texture.
//
// A face is the unit of all that follows: two rays that hit the same face hit the same plane, whatever the triangles
// are. Part frame L, metres. Thread safety: values and pure functions.
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

// A plane face. Its texture has the coordinates s and t, and repeats where either grows by 1.
struct Face {
  Eigen::Vector3d normal;  // unit, outward
  double distance;         // normal . p of its points
  Affine s, t;
  Material material;
  Eigen::Vector2d half{0, 0};  // of a box: |s| and |t| at its edges, which are drawn; 0: no edges
  double s_per_track_m = 0;    // how far s moves when the belt of `track` does
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

// What of a robot is one rigid part: B with hull and both main tracks, and an arm, whose frame is at its pivot, x out
// along the arm. Outlines are the physics' own (physics/robot_shapes.hpp); belts show a lug every 30 mm, wherever the
// track's travel has taken it, and wheels stand 2 mm out of the sides so that ends and middle can be told apart: both
// are for the eye, no description has them.
Surface body_surface(const physics::RobotDescription& robot);
Surface flipper_surface(const physics::RobotDescription& robot, robot::Flipper which);

// Where the arm of a flipper is in B; 0: straight out along the body, positive: tip up.
physics::Pose flipper_pose(const physics::RobotDescription& robot, robot::Flipper which, double angle_rad);

}  // namespace kenaf::camera
