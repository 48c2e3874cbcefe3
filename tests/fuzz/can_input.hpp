// A fuzzer's bytes as what comes from a CAN bus.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

#include "can/canopen/frame.hpp"

namespace kenaf::fuzz {

struct CanInput {
  std::span<const std::uint8_t> rest;

  bool empty() const { return rest.empty(); }
  // 0 once nothing is left.
  std::uint8_t byte() {
    if (rest.empty()) return 0;
    const std::uint8_t first = rest.front();
    rest = rest.subspan(1);
    return first;
  }
  std::uint16_t word() {
    const unsigned low = byte();
    return static_cast<std::uint16_t>(low | unsigned{byte()} << 8);
  }
  // With `id` and `length`, and as many bytes from here.
  canopen::Frame frame(std::uint16_t id, std::uint8_t length) {
    canopen::Frame frame{.id = id, .length = length};
    std::generate_n(frame.data.begin(), length, [this] { return byte(); });
    return frame;
  }
  canopen::Frame any_frame() {
    const auto id = static_cast<std::uint16_t>(word() & 0x7ff);
    return frame(id, byte() % 9);
  }
};

inline void require(bool true_) {
  if (!true_) __builtin_trap();
}

}  // namespace kenaf::fuzz
