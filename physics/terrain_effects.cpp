#include "physics/terrain_effects.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kenaf::physics {
namespace {

constexpr double kThinnest_m = 0.001;
constexpr double kNoArea = 1e-9;  // of the squares of a triangle's edges: seen edge-on

// Whether the vertical line through `p_W` meets the box: clips the line against the box's three slabs.
bool is_above_or_below(const Box& box, const Eigen::Vector3d& p_W) {
  const Eigen::Quaterniond q_BoxW = box.X_WBox.q.conjugate();
  const Eigen::Vector3d from = q_BoxW * (p_W - box.X_WBox.p), along = q_BoxW * Eigen::Vector3d::UnitZ();
  double low = -std::numeric_limits<double>::infinity(), high = -low;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const double half = box.size_m[i] / 2;
    if (std::abs(along[i]) < 1e-12) {
      if (std::abs(from[i]) > half) return false;
      continue;
    }
    const double a = (-half - from[i]) / along[i], b = (half - from[i]) / along[i];
    low = std::max(low, std::min(a, b));
    high = std::min(high, std::max(a, b));
  }
  return low <= high;
}

// The same for a mesh: `p_W` lies within a triangle, seen from above.
bool is_above_or_below(const TriangleMesh& mesh, const Eigen::Vector3d& p_W) {
  const auto side = [&p_W](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return (b.x() - a.x()) * (p_W.y() - a.y()) - (b.y() - a.y()) * (p_W.x() - a.x());
  };
  return std::ranges::any_of(mesh.triangles, [&](const auto& triangle) {
    const Eigen::Vector3d &a = mesh.vertices_W[triangle[0]], &b = mesh.vertices_W[triangle[1]],
                          &c = mesh.vertices_W[triangle[2]];
    const double ab = side(a, b), bc = side(b, c), ca = side(c, a);
    // a vertical face covers nothing, although what is in line with it is on no side of its edges
    const double area = ab + bc + ca, edges = (b - a).squaredNorm() + (c - b).squaredNorm();
    if (std::abs(area) <= kNoArea * edges) return false;
    return (ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0);
  });
}

template <typename Obstacle>
bool is_under_a_start(const Obstacle& obstacle, const WorldDescription& world) {
  return std::ranges::any_of(world.start_poses,
                             [&](const StartPose& start) { return is_above_or_below(obstacle, start.X_WB.p); });
}

// Moves the uppermost face so that its height over any place changes by `height_m`: by height_m n_z along its normal.
void raise_top(Box& box, double height_m) {
  const Eigen::Matrix3d R = box.X_WBox.q.toRotationMatrix();
  Eigen::Index axis = 0;
  const double upward = R.row(2).cwiseAbs().maxCoeff(&axis);
  const double size = box.size_m[axis];
  const double thicker = std::max(height_m * upward, std::min(kThinnest_m, size) - size);
  box.size_m[axis] += thicker;
  box.X_WBox.p += R.col(axis) * (R(2, axis) < 0 ? -thicker / 2 : thicker / 2);
}

void raise_top(TriangleMesh& mesh, double height_m) {
  double lowest = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& p : mesh.vertices_W) lowest = std::min(lowest, p.z());
  for (Eigen::Vector3d& p : mesh.vertices_W)
    if (p.z() > lowest + kThinnest_m) p.z() = std::max(p.z() + height_m, lowest + kThinnest_m);
}

}  // namespace

WorldDescription with_terrain_effects(WorldDescription world, const Effects& effects) {
  const Eigen::Vector3d shift(effects.obstacle_position_m, 0, 0);
  const double height_m = effects.obstacle_height_m;
  if (height_m != 0 || shift.x() != 0) {
    for (Box& box : world.boxes) {
      if (box.mass_kg > 0) {
        box.X_WBox.p += shift + Eigen::Vector3d(0, 0, std::max(height_m, 0.0));
      } else if (!is_under_a_start(box, world)) {
        raise_top(box, height_m);
        box.X_WBox.p += shift;
      }
    }
    for (TriangleMesh& mesh : world.meshes) {
      if (is_under_a_start(mesh, world)) continue;
      raise_top(mesh, height_m);
      for (Eigen::Vector3d& p : mesh.vertices_W) p += shift;
    }
  }
  // The world turned under a fixed gravity is gravity turned the other way.
  if (effects.ground_slope_rad != 0 || effects.ground_bank_rad != 0)
    world.gravity_W_mps2 =
        rotation_from({effects.ground_bank_rad, effects.ground_slope_rad, 0}).conjugate() * world.gravity_W_mps2;
  return world;
}

}  // namespace kenaf::physics
