// Exact number of bits of a frame on the wire. ISO 11898-1, classical base frame format.
//
//   start of frame 1 | identifier 11 | RTR, IDE, FDF 1 each | length code 4 | data 8 n | CRC 15     stuffed: 34 + 8 n
//   CRC delimiter 1 | acknowledge 2 | end of frame 7 | space between frames 3                       not stuffed: 13
//
// After five equal bits the sender inserts one of opposite value, which counts as the first of the bits that follow.
#pragma once

#include <cstdint>

#include "can/canopen/frame.hpp"

namespace kenaf::canlog {

// The frame's CRC sequence: polynomial x^15 + x^14 + x^10 + x^8 + x^7 + x^4 + x^3 + 1 (0x4599), initial value 0.
std::uint16_t crc_of(const canopen::Frame& frame);

int stuff_bits(const canopen::Frame& frame);

// 47 + 8 n + stuff bits; at most canopen::worst_case_bits.
int wire_bits(const canopen::Frame& frame);

}  // namespace kenaf::canlog
