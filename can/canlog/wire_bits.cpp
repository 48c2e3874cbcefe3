#include "can/canlog/wire_bits.hpp"

#include <vector>

namespace kenaf::canlog {
namespace {

constexpr unsigned kPolynomial = 0x4599, kCrcBits = 15;
constexpr int kUnstuffedBits = 13, kRun = 5;

void append(std::vector<bool>& bits, unsigned value, unsigned count) {
  for (unsigned i = count; i-- > 0;) bits.push_back((value >> i & 1) != 0);
}

// From the start of frame to the end of the data.
std::vector<bool> covered_by_crc(const canopen::Frame& frame) {
  std::vector<bool> bits{false};
  append(bits, frame.id, 11);
  append(bits, 0, 3);  // RTR: a data frame; IDE: a base identifier; FDF: classic
  append(bits, frame.length, 4);
  for (unsigned i = 0; i < frame.length; ++i) append(bits, frame.data[i], 8);
  return bits;
}

unsigned crc_of(const std::vector<bool>& bits) {
  unsigned crc = 0;
  for (const bool bit : bits) {
    const bool differs = bit != ((crc >> (kCrcBits - 1) & 1) != 0);
    crc = crc << 1 & 0x7fff;
    if (differs) crc ^= kPolynomial;
  }
  return crc;
}

}  // namespace

std::uint16_t crc_of(const canopen::Frame& frame) {
  return static_cast<std::uint16_t>(crc_of(covered_by_crc(frame)));
}

int stuff_bits(const canopen::Frame& frame) {
  std::vector<bool> bits = covered_by_crc(frame);
  append(bits, crc_of(bits), kCrcBits);
  int stuffed = 0, run = 0;
  bool last = !bits.front();
  for (const bool bit : bits) {
    run = bit == last ? run + 1 : 1;
    last = bit;
    if (run < kRun) continue;
    ++stuffed;
    last = !bit;
    run = 1;
  }
  return stuffed;
}

int wire_bits(const canopen::Frame& frame) {
  const int stuffed_part = 34 + 8 * frame.length;
  return stuffed_part + stuff_bits(frame) + kUnstuffedBits;
}

}  // namespace kenaf::canlog
