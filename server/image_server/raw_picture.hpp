// A picture as USARSim's image server sends it raw: u16 width, u16 height, big-endian; then its rows from the top, each
// of 24-bit pixels blue, green, red, filled up with zeros to a multiple of 4 bytes. Pure function.
#pragma once

#include <cstdint>
#include <vector>

#include "camera/picture.hpp"

namespace kenaf::image_server {

// The part of the picture that lies within x, y, width, height; empty: none does. Any numbers will do.
std::vector<std::uint8_t> raw_picture(const camera::Picture& picture, std::uint32_t x, std::uint32_t y,
                                      std::uint32_t width, std::uint32_t height);

}  // namespace kenaf::image_server
