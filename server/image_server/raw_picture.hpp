// A picture in the raw format of USARSim's image server: u16 width, u16 height, big-endian; then its rows from the top,
// of 24-bit pixels blue, green, red, each padded with zeros to a multiple of 4 bytes. Pure function.
#pragma once

#include <cstdint>
#include <vector>

#include "camera/picture.hpp"

namespace kenaf::image_server {

// Returns the part of the picture within x, y, width, height; empty if there is none. Accepts any numbers.
std::vector<std::uint8_t> raw_picture(const camera::Picture& picture, std::uint32_t x, std::uint32_t y,
                                      std::uint32_t width, std::uint32_t height);

}  // namespace kenaf::image_server
