// Frames as they are written by hand: identifier and bytes; and as a failed test prints them.
#pragma once

#include <initializer_list>
#include <iomanip>
#include <optional>
#include <ostream>

#include "can/canopen/frame.hpp"

namespace kenaf::canopen {

inline Frame frame_of(std::uint16_t id, std::initializer_list<std::uint8_t> bytes) {
  return make_frame(id, std::span(bytes.begin(), bytes.size()));
}

// SDO (CiA 301, 7.2.4.3) to node 5, and from it.
inline Frame request(std::initializer_list<std::uint8_t> bytes) {
  return frame_of(0x605, bytes);
}
inline Frame answer(std::initializer_list<std::uint8_t> bytes) {
  return frame_of(0x585, bytes);
}

// In candump's form: "605#4041600000000000".
inline std::ostream& operator<<(std::ostream& out, const Frame& frame) {
  out << std::hex << std::setfill('0') << std::setw(3) << frame.id << '#';
  for (std::size_t i = 0; i < frame.length; ++i) out << std::setw(2) << int{frame.data[i]};
  return out << std::dec;
}

}  // namespace kenaf::canopen
