#include "camera/jpeg.hpp"

#include <turbojpeg.h>

#include <stdexcept>
#include <string>

namespace kenaf::camera {

namespace {

constexpr int kSampling = TJSAMP_420;

[[noreturn]] void fail(tjhandle turbo, const char* what) {
  throw std::runtime_error(std::string(what) + ": " + tjGetErrorStr2(turbo));
}

}  // namespace

JpegEncoder::JpegEncoder() : turbo_(tjInitCompress()) {
  if (!turbo_) fail(nullptr, "JPEG encoder");
}

JpegEncoder::~JpegEncoder() {
  tjDestroy(turbo_);
}

std::span<const std::uint8_t> JpegEncoder::encode(const Picture& picture, int quality) {
  if (quality < 1 || quality > 100) throw std::invalid_argument("JPEG quality: must be 1 to 100");
  buffer_.resize(tjBufSize(picture.width, picture.height, kSampling));
  unsigned char* out = buffer_.data();
  unsigned long size = buffer_.size();
  if (tjCompress2(turbo_, picture.rgb.data(), picture.width, 0, picture.height, TJPF_RGB, &out, &size, kSampling,
                  quality, TJFLAG_NOREALLOC) != 0)
    fail(turbo_, "JPEG encoder");
  return {buffer_.data(), size};
}

Picture decode_jpeg(std::span<const std::uint8_t> file) {
  const std::unique_ptr<void, int (*)(void*)> turbo(tjInitDecompress(), tjDestroy);
  if (!turbo) fail(nullptr, "JPEG decoder");
  Picture out;
  int sampling = 0, colours = 0;
  if (tjDecompressHeader3(turbo.get(), file.data(), file.size(), &out.width, &out.height, &sampling, &colours) != 0)
    fail(turbo.get(), "JPEG decoder");
  out.rgb.resize(3 * static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height));
  if (tjDecompress2(turbo.get(), file.data(), file.size(), out.rgb.data(), out.width, 0, out.height, TJPF_RGB, 0) != 0)
    fail(turbo.get(), "JPEG decoder");
  return out;
}

}  // namespace kenaf::camera
