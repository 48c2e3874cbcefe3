// Any bytes are a height map or are refused with a DescriptionError.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "physics/height_map.hpp"
#include "physics/robot_description.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kenaf::physics;
  try {
    const GreyPicture picture = read_grey_png({reinterpret_cast<const char*>(data), size});
    if (picture.values.size() != std::size_t{picture.width} * picture.height) __builtin_trap();
    const TriangleSurface surface = height_map_surface(picture, {2, 3, 1}, {0, 0, 5});
    if (surface.triangles.size() != 2 * std::size_t{picture.width - 1} * (picture.height - 1)) __builtin_trap();
    for (const Eigen::Vector3d& p : surface.vertices)
      if (!(p.z() >= 5 && p.z() <= 6)) __builtin_trap();
  } catch (const kenaf::description::DescriptionError&) {
  }
  return 0;
}
