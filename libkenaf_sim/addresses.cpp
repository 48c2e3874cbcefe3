#include "libkenaf_sim/addresses.hpp"

#include <fmt/format.h>

#include <optional>

#include "formats/protocol/host_port.hpp"
#include "hrt/error.hpp"

namespace kenaf::sim {

Addresses look_up(const char* key, const std::string& host_port, int socket_type) {
  const std::optional<protocol::HostPort> address = protocol::parse_host_port(host_port);
  if (!address || address->port == 0) {
    throw hrt::Error(HRT_E_CONFIG,
                     fmt::format("{} must be HOST:PORT with a port from 1 to 65535, not '{}'", key, host_port));
  }
  const addrinfo hints{.ai_flags = AI_NUMERICSERV,
                       .ai_family = AF_UNSPEC,
                       .ai_socktype = socket_type,
                       .ai_protocol = 0,
                       .ai_addrlen = 0,
                       .ai_addr = nullptr,
                       .ai_canonname = nullptr,
                       .ai_next = nullptr};
  addrinfo* found = nullptr;
  const std::string port = std::to_string(address->port);
  if (const int wrong = getaddrinfo(address->host.c_str(), port.c_str(), &hints, &found); wrong != 0) {
    throw hrt::Error(HRT_E_CONFIG, fmt::format("{} '{}': {}", key, host_port, gai_strerror(wrong)));
  }
  return {found, &freeaddrinfo};
}

}  // namespace kenaf::sim
