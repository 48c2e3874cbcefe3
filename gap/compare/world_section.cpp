#include "gap/compare/world_section.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace kenaf::gap::compare {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Polygon = std::vector<Vector2d>;

// Adds the point where the line from a to b meets the plane y = y_m, if one end is below y_m and the other is not.
void add_crossing(const Vector3d& a, const Vector3d& b, double y_m, std::vector<Vector2d>& points) {
  if ((a.y() < y_m) == (b.y() < y_m)) return;
  const Vector3d p = a + (y_m - a.y()) / (b.y() - a.y()) * (b - a);
  points.emplace_back(p.x(), p.z());
}

// Orders the corners of a convex outline by their bearing from the middle.
Polygon in_order(Polygon corners) {
  Vector2d middle = Vector2d::Zero();
  for (const Vector2d& corner : corners) middle += corner / static_cast<double>(corners.size());
  const auto bearing = [&middle](const Vector2d& p) { return std::atan2(p.y() - middle.y(), p.x() - middle.x()); };
  std::ranges::sort(corners, {}, bearing);
  return corners;
}

Polygon box_section(const physics::Box& box, double y_m) {
  std::array<Vector3d, 8> corners;
  for (unsigned i = 0; i < 8; ++i) {
    const Vector3d half((i & 1u) != 0 ? 0.5 : -0.5, (i & 2u) != 0 ? 0.5 : -0.5, (i & 4u) != 0 ? 0.5 : -0.5);
    corners[i] = box.X_WBox.p + box.X_WBox.q * half.cwiseProduct(box.size_m);
  }
  Polygon outline;
  for (unsigned i = 0; i < 8; ++i) {
    // The bits of a corner's index are its sides; an edge sets one more bit.
    for (const unsigned axis : {1u, 2u, 4u}) {
      if ((i & axis) == 0) add_crossing(corners[i], corners[i | axis], y_m, outline);
    }
  }
  return in_order(std::move(outline));
}

// The part of a convex outline where f(p) = a + b . p <= 0 (Sutherland and Hodgman's clipping by one line). An edge
// from p to q crosses f = 0 at p + f(p) / (f(p) - f(q)) (q - p).
Polygon clipped(const Polygon& outline, double a, const Vector2d& b) {
  Polygon inside;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vector2d &p = outline[i], &q = outline[(i + 1) % outline.size()];
    const double f_p = a + b.dot(p), f_q = a + b.dot(q);
    if (f_p <= 0) inside.push_back(p);
    if ((f_p <= 0) != (f_q <= 0)) inside.push_back(p + f_p / (f_p - f_q) * (q - p));
  }
  return inside;
}

Polygon plane_section(const physics::GroundPlane& plane, double y_m, const Vector2d& low, const Vector2d& high) {
  // Solid is where n . (p - p_0) <= 0; with y fixed that is a half plane in (x, z).
  const Vector3d normal = plane.X_WP.q * Vector3d::UnitZ();
  const Polygon all{low, {high.x(), low.y()}, high, {low.x(), high.y()}};
  return clipped(all, normal.y() * y_m - normal.dot(plane.X_WP.p), {normal.x(), normal.z()});
}

}  // namespace

WorldSection world_section(const physics::WorldDescription& world, double y_m, const Vector2d& low,
                           const Vector2d& high) {
  WorldSection section;
  const auto add = [&section](Polygon outline) {
    if (outline.size() >= 3) section.solids.push_back(std::move(outline));
  };
  for (const physics::GroundPlane& plane : world.planes) add(plane_section(plane, y_m, low, high));
  for (const physics::Box& box : world.boxes) {
    if (box.mass_kg == 0) add(box_section(box, y_m));
  }
  // A triangle that crosses the plane gives the line between its two crossings.
  for (const physics::TriangleMesh& mesh : world.meshes) {
    for (const auto& corners : mesh.triangles) {
      Polygon ends;
      for (unsigned i = 0; i < 3; ++i) {
        add_crossing(mesh.vertices_W[corners[i]], mesh.vertices_W[corners[(i + 1) % 3]], y_m, ends);
      }
      if (ends.size() == 2) section.surfaces.emplace_back(ends[0], ends[1]);
    }
  }
  return section;
}

void draw_section(plot::Chart& chart, const physics::WorldDescription& world, double y_m, const Vector2d& low,
                  const Vector2d& high) {
  const WorldSection section = world_section(world, y_m, low, high);
  for (const auto& solid : section.solids) chart.areas.push_back({solid, plot::Ink::ground});
  const Vector2d line_break{std::numeric_limits<double>::quiet_NaN(), 0};
  std::vector<Vector2d> meshes;
  for (const auto& [a, b] : section.surfaces) {
    const bool seen = std::max(a.x(), b.x()) > low.x() && std::min(a.x(), b.x()) < high.x();
    if (seen) meshes.insert(meshes.end(), {a, b, line_break});
  }
  if (!meshes.empty()) chart.areas.push_back({std::move(meshes), plot::Ink::ground, false});
}

}  // namespace kenaf::gap::compare
