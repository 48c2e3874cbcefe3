#include "can/canopen/frame.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace kenaf::canopen {

Frame make_frame(std::uint16_t id, std::span<const std::uint8_t> data) {
  if (data.size() > kMaxFrameBytes)
    throw std::length_error("a CAN frame has at most 8 bytes, not " + std::to_string(data.size()));
  Frame frame{.id = id, .length = static_cast<std::uint8_t>(data.size())};
  std::ranges::copy(data, frame.data.begin());
  return frame;
}

std::uint32_t get_unsigned(std::span<const std::uint8_t> data, std::size_t at, std::size_t bytes) {
  std::uint32_t value = 0;
  for (std::size_t i = bytes; i-- > 0;) value = value << 8 | data[at + i];
  return value;
}

std::int32_t get_signed(std::span<const std::uint8_t> data, std::size_t at, std::size_t bytes) {
  const std::size_t unused_bits = 32 - 8 * bytes;
  return static_cast<std::int32_t>(get_unsigned(data, at, bytes) << unused_bits) >> unused_bits;
}

void put(std::span<std::uint8_t> data, std::size_t at, std::size_t bytes, std::uint32_t value) {
  for (std::size_t i = 0; i < bytes; ++i) data[at + i] = static_cast<std::uint8_t>(value >> 8 * i);
}

std::optional<std::int32_t> bits_of(const Frame& frame, unsigned first_bit, unsigned bits) {
  if (first_bit + bits > 8u * frame.length) return std::nullopt;
  std::uint64_t all = 0;
  for (unsigned i = 0; i < frame.length; ++i) all |= std::uint64_t{frame.data[i]} << (8 * i);
  // shift to the top and back: the second shift extends the sign
  return static_cast<std::int32_t>(static_cast<std::int64_t>(all << (64 - first_bit - bits)) >> (64 - bits));
}

int worst_case_bits(const Frame& frame) {
  const int data_bits = frame.remote ? 0 : 8 * frame.length;
  return 47 + data_bits + (34 + data_bits - 1) / 4;
}

}  // namespace kenaf::canopen
