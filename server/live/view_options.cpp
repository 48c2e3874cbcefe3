#include "server/live/view_options.hpp"

#include <optional>
#include <stdexcept>

#include "formats/protocol/host_port.hpp"

namespace kenaf::live {

ViewOptions parse_view_options(std::string_view text) {
  ViewOptions options;
  if (text == "off") {
    options.on = false;
    return options;
  }
  const std::optional<protocol::HostPort> parsed = protocol::parse_host_port(text);
  const std::optional<std::string> host = parsed ? protocol::parse_listen_host(parsed->host) : std::nullopt;
  if (!host) {
    throw std::runtime_error(
        "must be ADDRESS:PORT, such as 127.0.0.1:8080 or [::1]:8080, with an address of this machine and a port from 0 "
        "to 65535, or off");
  }
  options.address = *host;
  options.port = parsed->port;
  return options;
}

std::string parse_view_token(std::string_view text) {
  constexpr std::string_view kUnreserved = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-._~";
  if (text.find_first_not_of(kUnreserved) != std::string_view::npos) {
    throw std::runtime_error("must have letters, digits and - . _ ~ only, because it is part of an address");
  }
  return std::string(text);
}

}  // namespace kenaf::live
