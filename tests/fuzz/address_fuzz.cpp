// Any text is an address or is refused with a runtime_error; what is accepted is written as it is read again.
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string_view>

#include "relayd/sockets.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kenaf::relayd;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    if (parse_host_port(text).host.empty()) __builtin_trap();
    const Address address = parse_address(text);
    if (parse_address(to_text(address)) != address) __builtin_trap();
  } catch (const std::runtime_error&) {
  }
  return 0;
}
