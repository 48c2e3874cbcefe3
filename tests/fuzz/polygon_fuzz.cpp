// Any points are a polygon whose triangles cover its area, or are refused with a DescriptionError.
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "physics/robot_description.hpp"
#include "physics/surface_shapes.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kenaf::physics;
  std::vector<Eigen::Vector2d> corners;
  for (std::size_t i = 0; i + 1 < size && corners.size() < 60; i += 2)
    corners.emplace_back(data[i] / 10.0, data[i + 1] / 10.0);
  double twice_area = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector2d &a = corners[i], &b = corners[(i + 1) % corners.size()];
    twice_area += a.x() * b.y() - a.y() * b.x();
  }
  try {
    TriangleSurface prism = prism_surface(corners, 2);
    if (std::abs(volume_m3(prism) - std::abs(twice_area)) > 1e-6) __builtin_trap();
    if (!tidy(prism).closed) __builtin_trap();
  } catch (const kenaf::description::DescriptionError&) {
  }
  return 0;
}
