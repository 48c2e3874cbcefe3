// A datagram's bytes, and one to encode.
#pragma once

#include <cstddef>
#include <vector>

#include "formats/protocol/relay_datagram.hpp"

namespace kenaf::protocol::relay {

inline std::vector<std::byte> encoded(const Datagram& datagram) {
  std::vector<std::byte> out(kMaxDatagramBytes);
  out.resize(encode(datagram, out));
  return out;
}

inline State empty_state() {
  State state{};
  state.session = 1;
  return state;
}

}  // namespace kenaf::protocol::relay
