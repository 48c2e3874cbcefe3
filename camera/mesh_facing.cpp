#include "camera/mesh_facing.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "physics/triangle_surface.hpp"

namespace kenaf::camera {

namespace {

const double kSmooth_cos = std::cos(35 * std::numbers::pi / 180);

}  // namespace

std::vector<std::array<float, 3>> mesh_facing(const physics::TriangleMesh& mesh, const Eigen::Vector3d& toward_sun_W) {
  const auto& triangles = mesh.triangles;
  // Files often have vertices of their own for each triangle.
  const std::vector<std::uint32_t> vertex = physics::places_of(mesh.vertices_W);
  std::vector<Eigen::Vector3f> area(triangles.size());  // along the normal
  std::vector<std::uint32_t> end(mesh.vertices_W.size() + 1, 0);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const auto& [a, b, c] = triangles[i];
    const auto& p = mesh.vertices_W;
    area[i] = (p[b] - p[a]).cross(p[c] - p[a]).cast<float>();
    for (const std::uint32_t corner : triangles[i]) ++end[vertex[corner] + 1];
  }

  // The triangles around each vertex, one list after the other.
  std::partial_sum(end.begin(), end.end(), end.begin());
  std::vector<std::uint32_t> around(3 * triangles.size());
  std::vector<std::uint32_t> at(end.begin(), end.end() - 1);
  for (std::size_t i = 0; i < triangles.size(); ++i)
    for (const std::uint32_t corner : triangles[i]) around[at[vertex[corner]]++] = static_cast<std::uint32_t>(i);

  // At each corner, the sum of the areas of the triangles that are inclined by less than 35 degrees.
  std::vector<std::array<float, 3>> facing(triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = vertex[triangles[i][k]];
      Eigen::Vector3f sum(0, 0, 0);
      for (std::uint32_t j = end[v]; j < end[v + 1]; ++j) {
        const Eigen::Vector3f& other = area[around[j]];
        if (other.dot(area[i]) >= static_cast<float>(kSmooth_cos) * other.norm() * area[i].norm()) sum += other;
      }
      const float length = sum.norm();
      facing[i][k] = length > 0 ? std::max(0.0f, sum.dot(toward_sun_W.cast<float>()) / length) : 0.0f;
    }
  }
  return facing;
}

}  // namespace kenaf::camera
