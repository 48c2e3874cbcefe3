// Fewer points for the same line.
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

namespace kenaf::gap::plot {

// Leaves points out so that none of them was farther than `tolerance` from what is left (Ramer, Douglas and Peucker).
// First and last stay. All finite.
std::vector<Eigen::Vector2d> simplified(std::span<const Eigen::Vector2d> points, double tolerance);

}  // namespace kenaf::gap::plot
