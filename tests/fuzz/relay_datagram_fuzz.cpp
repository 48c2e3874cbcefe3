// What decodes encodes to the same bytes again: there is one way to write each datagram.
#include <algorithm>
#include <cstdlib>

#include "formats/protocol/relay_datagram.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kenaf::protocol::relay;
  const std::span<const std::byte> bytes = std::as_bytes(std::span(data, size));
  Datagram datagram = Bye{1};
  if (decode(bytes, datagram) != kenaf::protocol::DecodeError::none) return 0;
  std::array<std::byte, kMaxDatagramBytes> again;
  const std::size_t used = encode(datagram, again);
  if (!std::equal(bytes.begin(), bytes.end(), again.begin(), again.begin() + static_cast<std::ptrdiff_t>(used))) {
    std::abort();
  }
  return 0;
}
