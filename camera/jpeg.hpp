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

  // The bytes of a JPEG file (baseline, 4:2:0: colour at half the resolution); valid until the next call. `quality`: 1
  // to 100, else std::invalid_argument. The buffer is used again; what TurboJPEG allocates for a picture (some 40
  // blocks) it gives back.
  std::span<const std::uint8_t> encode(const Picture& picture, int quality);

 private:
  void* turbo_;
  std::vector<std::uint8_t> buffer_;
};

// The picture of a JPEG file; std::runtime_error where it is none.
Picture decode_jpeg(std::span<const std::uint8_t> file);

}  // namespace kenaf::camera
