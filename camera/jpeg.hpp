// Pictures as JPEG, by TurboJPEG. Thread safety: none; one encoder for each thread.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "camera/picture.hpp"

namespace kenaf::camera {

class JpegEncoder {
 public:
  JpegEncoder();
  ~JpegEncoder();
  JpegEncoder(const JpegEncoder&) = delete;
  JpegEncoder& operator=(const JpegEncoder&) = delete;

  // Returns the bytes of a JPEG file (baseline, 4:2:0: colour at half the resolution), valid until the next call.
  // Throws std::invalid_argument unless `quality` is from 1 to 100. Reuses its buffer; TurboJPEG frees its own
  // allocations for a picture (some 40 blocks).
  std::span<const std::uint8_t> encode(const Picture& picture, int quality);

 private:
  void* turbo_;
  std::vector<std::uint8_t> buffer_;
};

// Decodes a JPEG file. Throws std::runtime_error if it is none.
Picture decode_jpeg(std::span<const std::uint8_t> file);

}  // namespace kenaf::camera
