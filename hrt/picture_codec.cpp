#include "hrt/picture_codec.hpp"

#include <fmt/format.h>
#include <turbojpeg.h>

#include <algorithm>
#include <memory>
#include <string_view>

#include "hrt/error.hpp"

namespace kenaf::hrt {
namespace {

using Turbo = std::unique_ptr<void, int (*)(tjhandle)>;
using Encoding = CameraPicture::Encoding;

Turbo start_turbo(tjhandle (*init)()) {
  Turbo turbo(init(), tjDestroy);
  if (!turbo) throw Error(HRT_E_INTERNAL, fmt::format("TurboJPEG cannot be initialized: {}", tjGetErrorStr2(nullptr)));
  return turbo;
}

[[noreturn]] void damaged(const CameraPicture& picture, std::string_view why) {
  throw Error(HRT_E_DEVICE, fmt::format("picture {} of the camera is damaged: {}", picture.number, why));
}

// ITU-R BT.601, 8 bits: Y from 16 to 235, U and V from 16 to 240 around 128. Coefficients in 1/65536, rounded.
void yuyv_to_rgb(std::span<const std::uint8_t> yuyv, std::span<std::uint8_t> rgb) {
  constexpr int kY = 76309, kRed = 104597, kGreenU = 25675, kGreenV = 53279, kBlue = 132201, kHalf = 1 << 15;
  const auto level = [](int value) { return static_cast<std::uint8_t>(std::clamp(value >> 16, 0, 255)); };
  std::uint8_t* out = rgb.data();
  for (std::size_t at = 0; at + 3 < yuyv.size(); at += 4) {
    const int u = yuyv[at + 1] - 128, v = yuyv[at + 3] - 128;
    for (const int luma : {yuyv[at], yuyv[at + 2]}) {
      const int y = kY * (luma - 16) + kHalf;
      *out++ = level(y + kRed * v);
      *out++ = level(y - kGreenU * u - kGreenV * v);
      *out++ = level(y + kBlue * u);
    }
  }
}

}  // namespace

PictureSize picture_size(const CameraPicture& picture) {
  PictureSize size{picture.width, picture.height};
  if (picture.encoding == Encoding::jpeg) {
    const Turbo turbo = start_turbo(tjInitDecompress);
    int sampling = 0, colours = 0;
    if (tjDecompressHeader3(turbo.get(), picture.bytes.data(), picture.bytes.size(), &size.width, &size.height,
                            &sampling, &colours) != 0)
      damaged(picture, tjGetErrorStr2(turbo.get()));
  }
  if (size.width < 1 || size.height < 1 || size.width > kMaxSide || size.height > kMaxSide)
    throw Error(HRT_E_DEVICE,
                fmt::format("picture {} of the camera claims {} x {} pixels; at most {} x {} are accepted",
                            picture.number, size.width, size.height, kMaxSide, kMaxSide));
  return size;
}

void write_rgb(const CameraPicture& picture, std::span<std::uint8_t> rgb) {
  if (picture.encoding == Encoding::rgb) {
    std::ranges::copy(picture.bytes, rgb.begin());
    return;
  }
  if (picture.encoding == Encoding::yuyv) return yuyv_to_rgb(picture.bytes, rgb);
  const PictureSize size = picture_size(picture);
  const Turbo turbo = start_turbo(tjInitDecompress);
  if (tjDecompress2(turbo.get(), picture.bytes.data(), picture.bytes.size(), rgb.data(), size.width, 0, size.height,
                    TJPF_RGB, TJFLAG_LIMITSCANS) == 0)
    return;
  // Extraneous bytes between segments are common with webcams and harmless; all other warnings mean grey areas.
  const std::string_view why = tjGetErrorStr2(turbo.get());
  const bool harmless =
      tjGetErrorCode(turbo.get()) == TJERR_WARNING && why.find("extraneous bytes") != std::string_view::npos;
  if (!harmless) damaged(picture, why);
}

std::span<const std::uint8_t> jpeg_file(const CameraPicture& picture, std::vector<std::uint8_t>& made) {
  if (picture.encoding == Encoding::jpeg) return picture.bytes;
  const PictureSize size = picture_size(picture);
  std::vector<std::uint8_t> converted;
  if (picture.encoding == Encoding::yuyv) {
    converted.resize(size.rgb_bytes());
    yuyv_to_rgb(picture.bytes, converted);
  }
  const std::vector<std::uint8_t>& rgb = picture.encoding == Encoding::yuyv ? converted : picture.bytes;
  const Turbo turbo = start_turbo(tjInitCompress);
  made.resize(tjBufSize(size.width, size.height, TJSAMP_420));
  unsigned char* out = made.data();
  unsigned long bytes = made.size();
  if (tjCompress2(turbo.get(), rgb.data(), size.width, 0, size.height, TJPF_RGB, &out, &bytes, TJSAMP_420,
                  picture.jpeg_quality, TJFLAG_NOREALLOC) != 0)
    throw Error(HRT_E_INTERNAL, fmt::format("TurboJPEG: {}", tjGetErrorStr2(turbo.get())));
  return {made.data(), bytes};
}

}  // namespace kenaf::hrt
