// Reads numbers and texts of a record one after the other, and never beyond its end.
//
// Thread safety: a value.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "gap/recordings/recording_error.hpp"

namespace kenaf::gap::recordings {

// The number that the first bytes hold, of which there are enough.
template <class Number>
Number number_at(const char* bytes, std::endian order) {
  std::array<char, sizeof(Number)> copy;
  std::memcpy(copy.data(), bytes, copy.size());
  if (order != std::endian::native) std::ranges::reverse(copy);
  return std::bit_cast<Number>(copy);
}

class ByteCursor {
 public:
  explicit ByteCursor(std::string_view bytes) : bytes_(bytes) {}

  // Each throws RecordingError if fewer bytes are left.
  std::string_view take(std::uint64_t count) {
    if (count > left())
      throw RecordingError(
          fmt::format("{} bytes at byte {} are beyond its end, at byte {}", count, at_, bytes_.size()));
    const std::string_view taken = bytes_.substr(at_, count);
    at_ += count;
    return taken;
  }
  template <class Number>
  Number number() {  // little endian
    return number_at<Number>(take(sizeof(Number)).data(), std::endian::little);
  }
  std::string_view text() { return take(number<std::uint32_t>()); }  // after its length in 32 bits

  std::size_t position() const { return at_; }
  std::size_t left() const { return bytes_.size() - at_; }
  std::string_view rest() const { return bytes_.substr(at_); }

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
};

}  // namespace kenaf::gap::recordings
