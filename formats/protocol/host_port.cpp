#include "formats/protocol/host_port.hpp"

#include <charconv>

namespace kenaf::protocol {

std::optional<HostPortText> split_host_port(std::string_view text) {
  const std::size_t colon = text.rfind(':');
  if (colon == std::string_view::npos) return std::nullopt;
  std::string_view host = text.substr(0, colon);
  const std::string_view port = text.substr(colon + 1);
  if (host.size() >= 2 && host.front() == '[' && host.back() == ']') host = host.substr(1, host.size() - 2);
  if (host.empty() || port.empty()) return std::nullopt;
  return HostPortText{host, port};
}

std::optional<HostPort> parse_host_port(std::string_view text) {
  const std::optional<HostPortText> sides = split_host_port(text);
  if (!sides) return std::nullopt;
  HostPort out{std::string(sides->host)};
  const char* const last = sides->port.data() + sides->port.size();
  const auto [end, error] = std::from_chars(sides->port.data(), last, out.port);
  if (error != std::errc{} || end != last) return std::nullopt;
  return out;
}

}  // namespace kenaf::protocol
