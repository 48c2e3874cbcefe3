#include "server/image_server/raw_picture.hpp"

#include <algorithm>

namespace kenaf::image_server {

std::vector<std::uint8_t> raw_picture(const camera::Picture& picture, std::uint32_t x, std::uint32_t y,
                                      std::uint32_t width, std::uint32_t height) {
  const auto all_columns = static_cast<std::uint32_t>(picture.width);
  const auto all_rows = static_cast<std::uint32_t>(picture.height);
  if (x >= all_columns || y >= all_rows) return {};
  const std::uint32_t columns = std::min(width, all_columns - x), rows = std::min(height, all_rows - y);
  if (columns == 0 || rows == 0) return {};
  const std::size_t pitch = (3 * std::size_t{columns} + 3) / 4 * 4;
  std::vector<std::uint8_t> out(4 + pitch * rows);
  out[0] = static_cast<std::uint8_t>(columns >> 8);
  out[1] = static_cast<std::uint8_t>(columns & 0xff);
  out[2] = static_cast<std::uint8_t>(rows >> 8);
  out[3] = static_cast<std::uint8_t>(rows & 0xff);
  for (std::uint32_t row = 0; row < rows; ++row) {
    const std::uint8_t* from = picture.at(static_cast<int>(x), static_cast<int>(y + row));
    std::uint8_t* to = &out[4 + pitch * row];
    for (std::uint32_t column = 0; column < columns; ++column, from += 3, to += 3) {
      to[0] = from[2];
      to[1] = from[1];
      to[2] = from[0];
    }
  }
  return out;
}

}  // namespace kenaf::image_server
