#include "formats/protocol/host_port.hpp"

#include <arpa/inet.h>

#include <charconv>

namespace kenaf::protocol {
namespace {

bool is_ipv4(std::string_view host) {
  in_addr address{};
  return ::inet_pton(AF_INET, std::string(host).c_str(), &address) == 1;
}

// The text, or what is between its brackets, which only an IPv6 address has (RFC 3986, section 3.2.2). Other brackets
// are no part of a host, and colons are those of IPv6.
std::optional<std::string_view> host_of(std::string_view text) {
  const bool has_brackets = text.size() >= 2 && text.front() == '[' && text.back() == ']';
  const std::string_view host = has_brackets ? text.substr(1, text.size() - 2) : text;
  const bool must_be_ipv6 = has_brackets || host.find(':') != std::string_view::npos;
  const bool is_fine =
      must_be_ipv6 ? is_ipv6(host) : !host.empty() && host.find_first_of("[]") == std::string_view::npos;
  return is_fine ? std::optional(host) : std::nullopt;
}

}  // namespace

std::string to_text(const HostPort& address) {
  const bool needs_brackets = address.host.find(':') != std::string::npos;
  return (needs_brackets ? "[" + address.host + "]" : address.host) + ":" + std::to_string(address.port);
}

bool is_ipv6(std::string_view host) {
  const std::size_t percent = host.find('%');
  if (percent != std::string_view::npos && percent + 1 == host.size()) return false;
  in6_addr address{};
  // a zero byte would end the text that inet_pton() reads
  return host.find('\0') == std::string_view::npos &&
         ::inet_pton(AF_INET6, std::string(host.substr(0, percent)).c_str(), &address) == 1;
}

std::optional<HostPortText> split_host_port(std::string_view text) {
  const std::size_t colon = text.rfind(':');
  if (colon == std::string_view::npos) return std::nullopt;
  const std::optional<std::string_view> host = host_of(text.substr(0, colon));
  const std::string_view port = text.substr(colon + 1);
  if (!host || port.empty()) return std::nullopt;
  return HostPortText{*host, port};
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

std::optional<std::string> parse_host(std::string_view text) {
  const std::optional<std::string_view> host = host_of(text);
  return host ? std::optional(std::string(*host)) : std::nullopt;
}

std::optional<std::string> parse_listen_host(std::string_view text) {
  const std::optional<std::string> host = parse_host(text);
  if (host == "localhost") return "127.0.0.1";
  return host && (is_ipv4(*host) || is_ipv6(*host)) && host->find('\0') == std::string::npos ? host : std::nullopt;
}

}  // namespace kenaf::protocol
