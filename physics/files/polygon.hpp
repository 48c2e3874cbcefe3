// A plane polygon cut into triangles.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace kenaf::physics {

// Puts the corners in counter-clockwise order, drops a last one that repeats the first and those on a straight line
// between their neighbours, and returns triangles of indices into the remaining ones, counter-clockwise too.
// Throws DescriptionError if there are fewer than 3 or more than 500 points, or the polygon touches or crosses itself.
std::vector<std::array<std::uint32_t, 3>> triangulate(std::vector<Eigen::Vector2d>& corners);

}  // namespace kenaf::physics
