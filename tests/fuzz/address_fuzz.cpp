// Any text is HOST:PORT or is refused. What is accepted is read again as it is written, IPv6 with brackets and without;
// an address that the relay listens on, as the relay writes it.
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

#include "formats/protocol/host_port.hpp"
#include "relayd/sockets.hpp"

namespace {

using namespace kenaf;

void require(bool fine) {
  if (!fine) __builtin_trap();
}

void check_host_port(std::string_view text) {
  const auto sides = protocol::split_host_port(text);
  if (sides) require(!sides->host.empty() && !sides->port.empty());
  const auto parsed = protocol::parse_host_port(text);
  if (!parsed) return;
  require(sides && sides->host == parsed->host);
  require(protocol::parse_host_port(protocol::to_text(*parsed)) == parsed);
  if (protocol::is_ipv6(parsed->host))
    require(protocol::parse_host_port("[" + parsed->host + "]:" + std::to_string(parsed->port)) == parsed);
}

void check_host(std::string_view text) {
  const auto host = protocol::parse_host(text);
  if (host)
    require(!host->empty() && protocol::parse_host(*host) == host &&
            protocol::parse_host("[" + *host + "]").has_value() == protocol::is_ipv6(*host));
  if (const auto listened = protocol::parse_listen_host(text)) require(protocol::parse_host(*listened) == listened);
}

void check_address(std::string_view text) {
  try {
    const relayd::Address address = relayd::parse_address(text);
    require(protocol::parse_host_port(text).has_value());
    require(relayd::parse_address(to_text(address)) == address);
  } catch (const std::runtime_error&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  check_host_port(text);
  check_host(text);
  check_address(text);
  return 0;
}
