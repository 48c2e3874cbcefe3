// A colour picture: 3 bytes a pixel, red, green, blue; rows from the top, each from the left, without padding.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace kenaf::camera {

struct Picture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
  // The first of the three bytes of a pixel.
  const std::uint8_t* at(int column, int row) const {
    return &rgb[3 *
                (static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column))];
  }
};

}  // namespace kenaf::camera
