// Any bytes of a camera: a picture in RGB, which becomes a JPEG of the same size, or an error of the camera.
//
// The first byte says how it is encoded; that of one without a header, the next two its size.
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "hrt/error.hpp"
#include "hrt/picture_codec.hpp"

using namespace kenaf::hrt;

namespace {

using Encoding = CameraPicture::Encoding;

constexpr std::size_t kMost_bytes = std::size_t{3} << 20;  // a large picture is slow, and nothing else

void require(bool fine) {
  if (!fine) __builtin_trap();
}

// As cameras promise it: as many bytes as the size says. What is missing is 0.
CameraPicture without_header(Encoding encoding, int width, int height, std::span<const std::uint8_t> bytes) {
  CameraPicture picture;
  picture.encoding = encoding;
  picture.width = width;
  picture.height = height;
  picture.bytes.assign(bytes.begin(), bytes.end());
  const std::size_t pixel_bytes = encoding == Encoding::yuyv ? 2 : 3;
  picture.bytes.resize(pixel_bytes * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  return picture;
}

void take(const CameraPicture& picture) {
  const PictureSize size = picture_size(picture);
  require(size.width >= 1 && size.width <= kMaxSide && size.height >= 1 && size.height <= kMaxSide);
  if (size.rgb_bytes() > kMost_bytes) return;
  std::vector<std::uint8_t> rgb(size.rgb_bytes());
  write_rgb(picture, rgb);
  std::vector<std::uint8_t> made;
  CameraPicture again;
  const auto file = jpeg_file(without_header(Encoding::rgb, size.width, size.height, rgb), made);
  again.bytes.assign(file.begin(), file.end());
  const PictureSize same = picture_size(again);
  require(same.width == size.width && same.height == size.height);
  require(picture.encoding != Encoding::jpeg || jpeg_file(picture, made).size() == picture.bytes.size());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 3) return 0;
  const std::span<const std::uint8_t> bytes(data, size);
  CameraPicture picture;
  if (data[0] % 3 == 0) {
    picture.bytes.assign(bytes.begin() + 1, bytes.end());
  } else if (data[0] % 3 == 1) {
    picture = without_header(Encoding::rgb, data[1], data[2], bytes.subspan(3));
  } else {
    picture = without_header(Encoding::yuyv, data[1] & ~1, data[2], bytes.subspan(3));
  }
  try {
    take(picture);
  } catch (const Error& error) {
    require(error.code() == HRT_E_DEVICE);
  }
  return 0;
}
