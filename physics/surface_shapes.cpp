#include "physics/surface_shapes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "physics/files/polygon.hpp"

namespace kenaf::physics {
namespace {

constexpr double kChordError_m = 1e-3;
constexpr int kFewestSegments = 12, kMostSegments = 256;

// Number of segments of a circle whose chords are within `error_m` of it: a segment's half angle a has
// r (1 - cos a) <= error. A multiple of four, so that the polygon has the circle's full width along x and y.
int segments(double radius_m, double error_m) {
  if (error_m >= radius_m) return kFewestSegments;
  const double quarter = std::ceil(std::numbers::pi / std::acos(1 - error_m / radius_m) / 4);
  return static_cast<int>(std::clamp(4 * quarter, double{kFewestSegments}, double{kMostSegments}));
}

std::uint32_t index(std::size_t i) {
  return static_cast<std::uint32_t>(i);
}

// Revolves a profile of (radius, z), from the bottom to the top of the axis, about z. A point on the axis is one
// vertex.
TriangleSurface revolved(const std::vector<Eigen::Vector2d>& profile, int around) {
  TriangleSurface surface;
  const auto n = static_cast<std::size_t>(around);
  std::vector<std::size_t> ring_start;
  for (const Eigen::Vector2d& point : profile) {
    ring_start.push_back(surface.vertices.size());
    const std::size_t corners = point.x() > 0 ? n : 1;
    for (std::size_t i = 0; i < corners; ++i) {
      const double angle = 2 * std::numbers::pi * static_cast<double>(i) / around;
      surface.vertices.emplace_back(point.x() * std::cos(angle), point.x() * std::sin(angle), point.y());
    }
  }
  for (std::size_t ring = 0; ring + 1 < profile.size(); ++ring) {
    const bool pole_below = !(profile[ring].x() > 0), pole_above = !(profile[ring + 1].x() > 0);
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t next = (i + 1) % n;
      const auto below = [&](std::size_t k) { return index(ring_start[ring] + (pole_below ? 0 : k)); };
      const auto above = [&](std::size_t k) { return index(ring_start[ring + 1] + (pole_above ? 0 : k)); };
      if (!pole_below) surface.triangles.push_back({below(i), below(next), above(next)});
      if (!pole_above) surface.triangles.push_back({below(i), above(next), above(i)});
    }
  }
  return surface;
}

// A quarter circle about (0, z) from the pole below to the equator, or from the equator to the pole above.
void append_quarter(std::vector<Eigen::Vector2d>& profile, double radius_m, double z_m, int steps, bool upper) {
  for (int i = 0; i <= steps; ++i) {
    const bool pole = upper ? i == steps : i == 0;
    const double latitude = std::numbers::pi / 2 * ((upper ? 0.0 : -1.0) + static_cast<double>(i) / steps);
    profile.emplace_back(pole ? 0 : radius_m * std::cos(latitude), z_m + radius_m * std::sin(latitude));
  }
}

}  // namespace

TriangleSurface cylinder_surface(double radius_m, double length_m) {
  const double half = length_m / 2;
  return revolved({{0, -half}, {radius_m, -half}, {radius_m, half}, {0, half}}, segments(radius_m, kChordError_m));
}

TriangleSurface capsule_surface(double radius_m, double length_m) {
  // The errors along and across the meridians add up.
  const int around = segments(radius_m, kChordError_m / 2);
  const int quarter = around / 4;
  std::vector<Eigen::Vector2d> profile;
  append_quarter(profile, radius_m, -length_m / 2, quarter, false);
  if (!(length_m > 0)) profile.pop_back();  // a sphere has one equator
  append_quarter(profile, radius_m, length_m / 2, quarter, true);
  return revolved(profile, around);
}

TriangleSurface sphere_surface(double radius_m) {
  return capsule_surface(radius_m, 0);
}

TriangleSurface ellipsoid_surface(const Eigen::Vector3d& radii_m) {
  const double largest = radii_m.maxCoeff();
  TriangleSurface surface = sphere_surface(largest);
  for (Eigen::Vector3d& p : surface.vertices) p = p.cwiseProduct(radii_m / largest);
  return surface;
}

TriangleSurface prism_surface(std::vector<Eigen::Vector2d> corners_m, double height_m) {
  const std::vector<std::array<std::uint32_t, 3>> faces = triangulate(corners_m);
  TriangleSurface surface;
  const std::size_t n = corners_m.size();
  for (const double z : {0.0, height_m})
    for (const Eigen::Vector2d& p : corners_m) surface.vertices.emplace_back(p.x(), p.y(), z);
  for (const auto& [a, b, c] : faces) {
    surface.triangles.push_back({a, c, b});
    surface.triangles.push_back({index(a + n), index(b + n), index(c + n)});
  }
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t next = (i + 1) % n;
    surface.triangles.push_back({index(i), index(next), index(next + n)});
    surface.triangles.push_back({index(i), index(next + n), index(i + n)});
  }
  return surface;
}

}  // namespace kenaf::physics
