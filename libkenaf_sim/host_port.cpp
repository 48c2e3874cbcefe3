#include "libkenaf_sim/host_port.hpp"

#include <fmt/format.h>

#include <charconv>
#include <utility>

#include "hrt/error.hpp"

namespace kenaf::sim {

HostPort parse_host_port(const char* key, const std::string& host_port) {
  const std::size_t colon = host_port.rfind(':');
  std::string host = host_port.substr(0, colon);
  if (host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
  const std::string port = colon == std::string::npos ? "" : host_port.substr(colon + 1);
  unsigned number = 0;
  const auto [end, wrong_digit] = std::from_chars(port.data(), port.data() + port.size(), number);
  if (host.empty() || wrong_digit != std::errc{} || end != port.data() + port.size() || number < 1 || number > 65535) {
    throw hrt::Error(HRT_E_CONFIG,
                     fmt::format("{} must be HOST:PORT with a port from 1 to 65535, not '{}'", key, host_port));
  }
  return {std::move(host), port};
}

Addresses look_up(const char* key, const std::string& host_port, int socket_type) {
  const HostPort address = parse_host_port(key, host_port);
  const addrinfo hints{.ai_flags = AI_NUMERICSERV,
                       .ai_family = AF_UNSPEC,
                       .ai_socktype = socket_type,
                       .ai_protocol = 0,
                       .ai_addrlen = 0,
                       .ai_addr = nullptr,
                       .ai_canonname = nullptr,
                       .ai_next = nullptr};
  addrinfo* found = nullptr;
  if (const int wrong = getaddrinfo(address.host.c_str(), address.port.c_str(), &hints, &found); wrong != 0) {
    throw hrt::Error(HRT_E_CONFIG, fmt::format("{} '{}': {}", key, host_port, gai_strerror(wrong)));
  }
  return {found, &freeaddrinfo};
}

}  // namespace kenaf::sim
