// Fewer points for the same line.
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

namespace kenaf::gap::plot {

// Leaves points out so that none of them was farther than `tolerance` from what is left (Ramer, Douglas and Peucker).
// First and last stay. All finite.
std::vector<Eigen::Vector2d> simplified(std::span<const Eigen::Vector2d> points, double tolerance);

// A dense line as a picture of so many columns has it: of each of `columns` equal spans of x the first, lowest, highest
// and last point, in their order. x must not fall. Points whose y is not finite, at which a line breaks, all stay.
std::vector<Eigen::Vector2d> envelope(std::span<const Eigen::Vector2d> points, std::size_t columns);

}  // namespace kenaf::gap::plot
