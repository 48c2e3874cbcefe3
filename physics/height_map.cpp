#include "physics/height_map.hpp"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <cstring>
#include <memory>
#include <string>

#include "physics/robot_description.hpp"

namespace kenaf::physics {
namespace {

struct PngReader {
  std::string_view left;
  std::string error;
  png_structp png = nullptr;
  png_infop info = nullptr;

  PngReader() = default;
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;
  ~PngReader() { png_destroy_read_struct(&png, &info, nullptr); }
};

void take_bytes(png_structp png, png_bytep out, std::size_t count) {
  std::string_view& left = static_cast<PngReader*>(png_get_io_ptr(png))->left;
  if (count > left.size()) png_error(png, "the file ends too early");
  std::memcpy(out, left.data(), count);
  left.remove_prefix(count);
}

[[noreturn]] void keep_error(png_structp png, png_const_charp words) {
  static_cast<PngReader*>(png_get_error_ptr(png))->error = words;
  png_longjmp(png, 1);
}

void ignore_warning(png_structp, png_const_charp) {}

// libpng reports errors by longjmp, which skips destructors: these two functions have nothing to destroy.
bool read_header(PngReader& reader) {
  if (setjmp(png_jmpbuf(reader.png))) return false;
  png_read_info(reader.png, reader.info);
  return true;
}

bool read_pixels(PngReader& reader, png_bytepp rows) {
  if (setjmp(png_jmpbuf(reader.png))) return false;
  png_read_image(reader.png, rows);
  return true;
}

}  // namespace

GreyPicture read_grey_png(std::string_view png) {
  // libpng reads from memory; chunks are limited, so that a small file cannot ask for much memory.
  PngReader reader;
  reader.left = png;
  reader.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &reader, keep_error, ignore_warning);
  if (reader.png) reader.info = png_create_info_struct(reader.png);
  if (!reader.info) throw description::DescriptionError("libpng does not start: too little memory");
  png_set_read_fn(reader.png, &reader, take_bytes);
  constexpr png_alloc_size_t kMostChunkBytes = 1U << 20U;
  png_set_chunk_malloc_max(reader.png, kMostChunkBytes);
  png_set_keep_unknown_chunks(reader.png, PNG_HANDLE_CHUNK_NEVER, nullptr, 0);
  if (!read_header(reader)) throw description::DescriptionError("is not a PNG picture: " + reader.error);

  // Only grey without transparency, of a size that makes a surface.
  GreyPicture picture;
  picture.width = png_get_image_width(reader.png, reader.info);
  picture.height = png_get_image_height(reader.png, reader.info);
  const auto [least, most] = std::minmax(picture.width, picture.height);
  if (least < 2 || most > kMostPixelsASide)
    throw description::DescriptionError(
        fmt::format("is {} x {} pixels; a height map must be from 2 to {} pixels a side", picture.width, picture.height,
                    kMostPixelsASide));
  const bool wide = png_get_bit_depth(reader.png, reader.info) == 16;
  if (png_get_color_type(reader.png, reader.info) != PNG_COLOR_TYPE_GRAY ||
      (!wide && png_get_bit_depth(reader.png, reader.info) != 8))
    throw description::DescriptionError("is not a grey picture of 8 or 16 bits without transparency; save it as one");

  // Rows of bytes, then values; PNG stores 16 bits big-endian.
  png_set_interlace_handling(reader.png);
  png_read_update_info(reader.png, reader.info);
  const std::size_t row_bytes = picture.width * (wide ? std::size_t{2} : std::size_t{1});
  std::vector<png_byte> bytes(row_bytes * picture.height);
  std::vector<png_bytep> rows;
  for (std::size_t row = 0; row < picture.height; ++row) rows.push_back(&bytes[row * row_bytes]);
  if (!read_pixels(reader, rows.data()))
    throw description::DescriptionError("is a damaged PNG picture: " + reader.error);
  picture.values.resize(std::size_t{picture.width} * picture.height);
  for (std::size_t i = 0; i < picture.values.size(); ++i)
    picture.values[i] = static_cast<std::uint16_t>(wide ? (bytes[2 * i] << 8) + bytes[2 * i + 1] : bytes[i]);
  return picture;
}

TriangleSurface height_map_surface(const GreyPicture& picture, const Eigen::Vector3d& size_m,
                                   const Eigen::Vector3d& position_m) {
  const std::uint32_t width = picture.width, height = picture.height;
  const double brightest = std::max<double>(1, *std::ranges::max_element(picture.values));

  // A vertex for each pixel.
  TriangleSurface surface;
  surface.vertices.reserve(picture.values.size());
  for (std::uint32_t row = 0; row < height; ++row) {
    for (std::uint32_t column = 0; column < width; ++column) {
      const double value = picture.values[std::size_t{row} * width + column];
      const Eigen::Vector3d share(static_cast<double>(column) / (width - 1) - 0.5,
                                  0.5 - static_cast<double>(row) / (height - 1), value / brightest);
      surface.vertices.emplace_back(position_m + share.cwiseProduct(size_m));
    }
  }

  // Each square of four pixels is cut along its diagonal.
  surface.triangles.reserve(2 * std::size_t{width - 1} * (height - 1));
  for (std::uint32_t row = 0; row + 1 < height; ++row) {
    for (std::uint32_t column = 0; column + 1 < width; ++column) {
      const std::uint32_t far_left = row * width + column, far_right = far_left + 1;  // far: towards +y
      const std::uint32_t near_left = far_left + width, near_right = near_left + 1;
      surface.triangles.push_back({near_left, near_right, far_right});
      surface.triangles.push_back({near_left, far_right, far_left});
    }
  }
  return surface;
}

}  // namespace kenaf::physics
