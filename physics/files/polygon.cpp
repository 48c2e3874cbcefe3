#include "physics/files/polygon.hpp"

#include <algorithm>
#include <numeric>

#include "physics/robot_description.hpp"

namespace kenaf::physics {
namespace {

using Eigen::Vector2d;

constexpr std::size_t kMostCorners = 500;

// Twice the area of a, b, c; more than 0: counter-clockwise.
double cross(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

// Whether c, which is in line with a and b, lies between them.
bool between(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  return (c - a).dot(c - b) <= 0;
}

// Segments a b and c d meet: each one's ends lie on both sides of the other, or an end lies on the other.
bool segments_meet(const Vector2d& a, const Vector2d& b, const Vector2d& c, const Vector2d& d) {
  const double c_side = cross(a, b, c), d_side = cross(a, b, d), a_side = cross(c, d, a), b_side = cross(c, d, b);
  if (((c_side > 0 && d_side < 0) || (c_side < 0 && d_side > 0)) &&
      ((a_side > 0 && b_side < 0) || (a_side < 0 && b_side > 0)))
    return true;
  return (c_side == 0 && between(a, b, c)) || (d_side == 0 && between(a, b, d)) || (a_side == 0 && between(c, d, a)) ||
         (b_side == 0 && between(c, d, b));
}

void drop_needless_corners(std::vector<Vector2d>& corners) {
  for (std::size_t i = 0; corners.size() >= 3 && i < corners.size();) {
    const std::size_t n = corners.size();
    const Vector2d &before = corners[(i + n - 1) % n], &at = corners[i], &after = corners[(i + 1) % n];
    if (cross(before, at, after) == 0 && between(before, after, at)) {
      corners.erase(corners.begin() + static_cast<std::ptrdiff_t>(i));
      i = i > 0 ? i - 1 : 0;
    } else {
      ++i;
    }
  }
}

bool is_simple(const std::vector<Vector2d>& corners) {
  const std::size_t n = corners.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vector2d &a = corners[i], &b = corners[(i + 1) % n];
    if (cross(a, b, corners[(i + 2) % n]) == 0) return false;  // turns back onto itself
    for (std::size_t j = i + 2; j < n; ++j) {
      const bool neighbours = i == 0 && j == n - 1;
      if (!neighbours && segments_meet(a, b, corners[j], corners[(j + 1) % n])) return false;
    }
  }
  return true;
}

}  // namespace

std::vector<std::array<std::uint32_t, 3>> triangulate(std::vector<Vector2d>& corners) {
  if (corners.size() > kMostCorners) throw description::DescriptionError("a polygon must have at most 500 corners");
  if (corners.size() > 1 && corners.front() == corners.back()) corners.pop_back();
  drop_needless_corners(corners);
  if (corners.size() < 3)
    throw description::DescriptionError("a polygon must have at least 3 corners that are not in line");
  constexpr const char* kNotSimple = "a polygon must not touch or cross itself";
  if (!is_simple(corners)) throw description::DescriptionError(kNotSimple);

  // Counter-clockwise, by the sign of the area: a fan of triangles from corner 0.
  double twice_area = 0;
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) twice_area += cross(corners[0], corners[i], corners[i + 1]);
  if (twice_area < 0) std::ranges::reverse(corners);

  // Ear clipping: a convex corner whose triangle holds no other corner is cut off, until one triangle is left.
  std::vector<std::uint32_t> left(corners.size());
  std::iota(left.begin(), left.end(), 0U);
  std::vector<std::array<std::uint32_t, 3>> triangles;
  while (left.size() >= 3) {
    const std::size_t n = left.size();
    const auto is_ear = [&](std::size_t i) {
      const std::array<std::uint32_t, 3> t{left[(i + n - 1) % n], left[i], left[(i + 1) % n]};
      const Vector2d &a = corners[t[0]], &b = corners[t[1]], &c = corners[t[2]];
      if (!(cross(a, b, c) > 0)) return false;
      return std::ranges::none_of(left, [&](std::uint32_t k) {
        if (std::ranges::find(t, k) != t.end()) return false;
        const Vector2d& p = corners[k];
        return cross(a, b, p) >= 0 && cross(b, c, p) >= 0 && cross(c, a, p) >= 0;
      });
    };
    std::size_t ear = 0;
    while (ear < n && !is_ear(ear)) ++ear;
    if (ear == n) throw description::DescriptionError(kNotSimple);  // up to rounding
    triangles.push_back({left[(ear + n - 1) % n], left[ear], left[(ear + 1) % n]});
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  return triangles;
}

}  // namespace kenaf::physics
