// A height map: a grey PNG picture as ground.
//
// Thread safety: pure functions.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "physics/triangle_surface.hpp"

namespace kenaf::physics {

inline constexpr std::uint32_t kMostPixelsASide = 1025;

struct GreyPicture {
  std::uint32_t width = 0, height = 0;
  std::vector<std::uint16_t> values;  // row by row from the top, 0 black; 8 bit pictures up to 255
};

// The bytes of a PNG file with one grey channel of 8 or 16 bits, 2 to kMostPixelsASide pixels a side. Throws
// DescriptionError, which says what is wrong but not where.
GreyPicture read_grey_png(std::string_view png);

// A surface of (width - 1) x (height - 1) squares, two triangles each, solid below: the picture's centre is at
// `position_m`, its columns run along +x over size x, its rows from +y down to -y over size y. Black is at position z,
// the brightest pixel of this picture size z above (as Gazebo scales it, whatever the pixel's value; a picture that is
// all black is flat).
TriangleSurface height_map_surface(const GreyPicture& picture, const Eigen::Vector3d& size_m,
                                   const Eigen::Vector3d& position_m);

}  // namespace kenaf::physics
