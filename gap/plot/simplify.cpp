#include "gap/plot/simplify.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace kenaf::gap::plot {

namespace {

using Eigen::Vector2d;

double distance_to_segment(const Vector2d& p, const Vector2d& a, const Vector2d& b) {
  const Vector2d along = b - a;
  const double squared = along.squaredNorm();
  const double share = squared > 0 ? std::clamp((p - a).dot(along) / squared, 0.0, 1.0) : 0;
  return (a + share * along - p).norm();
}

}  // namespace

std::vector<Vector2d> simplified(std::span<const Vector2d> points, double tolerance) {
  if (points.size() < 3) return {points.begin(), points.end()};
  std::vector<bool> stays(points.size(), false);
  stays.front() = stays.back() = true;

  // Each open piece keeps its point farthest from the chord if that is beyond the tolerance, and is split there.
  std::vector<std::pair<std::size_t, std::size_t>> open{{0, points.size() - 1}};
  while (!open.empty()) {
    const auto [first, last] = open.back();
    open.pop_back();
    std::size_t farthest = first;
    double most = tolerance;
    for (std::size_t i = first + 1; i < last; ++i) {
      const double distance = distance_to_segment(points[i], points[first], points[last]);
      if (distance > most) {
        most = distance;
        farthest = i;
      }
    }
    if (farthest == first) continue;
    stays[farthest] = true;
    open.emplace_back(first, farthest);
    open.emplace_back(farthest, last);
  }
  std::vector<Vector2d> kept;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (stays[i]) kept.push_back(points[i]);
  }
  return kept;
}

std::vector<Vector2d> envelope(std::span<const Vector2d> points, std::size_t columns) {
  if (points.size() <= 4 * columns) return {points.begin(), points.end()};
  const double first_x = points.front().x(), width = (points.back().x() - first_x) / static_cast<double>(columns);
  const auto column_of = [&](const Vector2d& p) { return std::floor((p.x() - first_x) / width); };
  const auto by_y = [](const Vector2d& a, const Vector2d& b) { return a.y() < b.y(); };
  std::vector<Vector2d> kept;
  for (std::size_t begin = 0; begin < points.size();) {
    // A piece is all finite points in one column, or a single point that is not finite.
    std::size_t end = begin + 1;
    const auto is_with_first = [&](const Vector2d& p) {
      return std::isfinite(p.y()) && std::isfinite(points[begin].y()) && column_of(p) == column_of(points[begin]);
    };
    while (end < points.size() && is_with_first(points[end])) ++end;

    // Its first, lowest, highest and last point in order, each once.
    const auto [low, high] = std::minmax_element(points.begin() + static_cast<std::ptrdiff_t>(begin),
                                                 points.begin() + static_cast<std::ptrdiff_t>(end), by_y);
    std::array<std::size_t, 4> corners{begin, static_cast<std::size_t>(low - points.begin()),
                                       static_cast<std::size_t>(high - points.begin()), end - 1};
    std::ranges::sort(corners);
    const auto last = std::unique(corners.begin(), corners.end());
    for (auto corner = corners.begin(); corner != last; ++corner) kept.push_back(points[*corner]);
    begin = end;
  }
  return kept;
}

}  // namespace kenaf::gap::plot
