// Reduces the points of a line without a visible change.
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

namespace kenaf::gap::plot {

// Leaves out points that are within `tolerance` of the remaining line (Ramer, Douglas and Peucker). First and last
// stay. All points must be finite.
std::vector<Eigen::Vector2d> simplified(std::span<const Eigen::Vector2d> points, double tolerance);

// Reduces a dense line to what a picture of `columns` columns can show: the first, lowest, highest and last point of
// each of that many equal spans of x, in their order. x must not decrease. Points whose y is not finite, at which a
// line breaks, all stay.
std::vector<Eigen::Vector2d> envelope(std::span<const Eigen::Vector2d> points, std::size_t columns);

}  // namespace kenaf::gap::plot
