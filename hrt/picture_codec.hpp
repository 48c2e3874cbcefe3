// Conversions between camera pictures and those of hrt.h: JPEG by TurboJPEG, YUYV. Thread safety: pure functions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "hrt/camera.hpp"

namespace kenaf::hrt {

struct PictureSize {
  int width, height;  // 1 to kMaxSide
  std::size_t rgb_bytes() const {
    return std::size_t{3} * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
};
// Larger sizes claimed by a file are rejected: decoding a progressive JPEG takes 6 bytes a pixel.
inline constexpr int kMaxSide = 4096;

// Each throws Error(HRT_E_DEVICE) saying what is wrong with the picture.
PictureSize picture_size(const CameraPicture& picture);
// `rgb` has rgb_bytes() bytes.
void write_rgb(const CameraPicture& picture, std::span<std::uint8_t> rgb);
// Returns the JPEG file; `made` holds it if it has to be encoded.
std::span<const std::uint8_t> jpeg_file(const CameraPicture& picture, std::vector<std::uint8_t>& made);

}  // namespace kenaf::hrt
