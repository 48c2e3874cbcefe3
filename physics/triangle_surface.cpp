#include "physics/triangle_surface.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>
#include <utility>

namespace kenaf::physics {
namespace {

constexpr double kLeastHeight_m = 1e-6;

// Renumbers the vertices in the order of use; those that no triangle uses are dropped.
void join_vertices(TriangleSurface& surface) {
  const std::vector<Eigen::Vector3d>& v = surface.vertices;
  const std::vector<std::uint32_t> place = places_of(v);
  constexpr auto kUnused = static_cast<std::uint32_t>(-1);
  std::vector<std::uint32_t> new_index(v.size(), kUnused);
  std::vector<Eigen::Vector3d> kept;
  for (auto& triangle : surface.triangles) {
    for (std::uint32_t& corner : triangle) {
      std::uint32_t& index = new_index[place[corner]];
      if (index == kUnused) {
        index = static_cast<std::uint32_t>(kept.size());
        kept.push_back(v[corner]);
      }
      corner = index;
    }
  }
  surface.vertices = std::move(kept);
}

void examine_edges(const TriangleSurface& surface, TidySurface& tidied) {
  // Each triangle's edges as (low vertex, high vertex), with whether the triangle runs upward along it.
  std::vector<std::pair<std::array<std::uint32_t, 2>, bool>> edges;
  edges.reserve(3 * surface.triangles.size());
  for (const auto& t : surface.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = t[i], b = t[(i + 1) % 3];
      edges.push_back({{std::min(a, b), std::max(a, b)}, a < b});
    }
  }

  // Sorted, the entries of one edge are neighbours. It is closed if as many run upward as downward; two that run the
  // same way are triangles of opposite winding.
  std::ranges::sort(edges);
  tidied.closed = !edges.empty();
  for (std::size_t i = 0, end = 0; i < edges.size(); i = end) {
    std::ptrdiff_t upward = 0;
    for (end = i; end < edges.size() && edges[end].first == edges[i].first; ++end) upward += edges[end].second ? 1 : -1;
    if (upward != 0) tidied.closed = false;
    if (end - i == 2 && upward != 0) tidied.windings_agree = false;
  }
}

// Height over the longest side, |(b - a) x (c - a)| / longest, is at most kLeastHeight_m.
bool too_thin(const TriangleSurface& surface, const std::array<std::uint32_t, 3>& t) {
  const Eigen::Vector3d &a = surface.vertices[t[0]], &b = surface.vertices[t[1]], &c = surface.vertices[t[2]];
  const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
  return !((b - a).cross(c - a).norm() > kLeastHeight_m * longest);
}

}  // namespace

std::vector<std::uint32_t> places_of(std::span<const Eigen::Vector3d> vertices) {
  // Sorted by coordinates, vertices at one place are neighbours: each gets the first of them.
  const auto& v = vertices;
  std::vector<std::uint32_t> order(v.size());
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::sort(order, [&](std::uint32_t a, std::uint32_t b) {
    return std::lexicographical_compare(v[a].begin(), v[a].end(), v[b].begin(), v[b].end());
  });
  std::vector<std::uint32_t> place(v.size());
  for (std::size_t i = 0; i < order.size(); ++i)
    place[order[i]] = i > 0 && v[order[i]] == v[order[i - 1]] ? place[order[i - 1]] : order[i];
  return place;
}

double volume_m3(const TriangleSurface& surface) {
  if (surface.vertices.empty()) return 0;
  // Sum of the tetrahedra from one point: V = sum a . (b x c) / 6. A vertex as that point keeps the rounding small.
  const Eigen::Vector3d& o = surface.vertices.front();
  double six_volumes = 0;
  for (const auto& t : surface.triangles) {
    const auto corner = [&](std::size_t i) -> Eigen::Vector3d { return surface.vertices[t[i]] - o; };
    six_volumes += corner(0).dot(corner(1).cross(corner(2)));
  }
  return six_volumes / 6;
}

TidySurface tidy(TriangleSurface& surface) {
  TidySurface tidied;
  join_vertices(surface);
  const auto pinched = [](const auto& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; };
  tidied.dropped = std::erase_if(surface.triangles, pinched);
  // Before thin triangles are dropped: one of them may be all that closes a crack.
  examine_edges(surface, tidied);
  if (tidied.closed && volume_m3(surface) < 0)
    for (auto& t : surface.triangles) std::swap(t[1], t[2]);
  tidied.dropped += std::erase_if(surface.triangles, [&](const auto& t) { return too_thin(surface, t); });
  return tidied;
}

}  // namespace kenaf::physics
