// HOST:PORT and HOST, by which command lines, configurations and variables name the ends of connections. One grammar
// for all of them:
//
//   HOST       a name, an IPv4 address, or an IPv6 address with or without brackets: "::1" and "[::1]" are the same
//   HOST:PORT  the last colon is the border, so that an IPv6 address may stand without brackets here too, if what is
//              before that colon is a whole address: "::1:80" is port 80 of ::1
//   PORT       of parse_host_port(): decimal digits alone, 0 to 65535; of split_host_port(): any text, not empty
//
// An IPv6 address may have a zone (RFC 4007, section 11): "fe80::1%eth0". Whether there is such a host is for the
// caller to find out: nothing here asks a name server, and other characters of a name are taken as they stand.
//
//   "127.0.0.1:45454"   "localhost:0"   "robot.example:3000"   "[fe80::1%eth0]:80"   "::1:80"
//
// Refused: "localhost", "localhost:", ":80", "[]:80", "host:70000", "host:-1", "host: 80", "::1", "[::1:80",
// "[localhost]:80", "a:b:80".
//
// Errors: nullopt; the caller knows what the text was for, and says so. Thread safety: pure functions.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace kenaf::protocol {

struct HostPort {
  std::string host;  // without brackets; not empty
  std::uint16_t port = 0;
  bool operator==(const HostPort&) const = default;
};
std::string to_text(const HostPort& address);  // "127.0.0.1:80", "[::1]:80"

// Ends of errors.
inline constexpr std::string_view kMustBeHostPort =
    "must be HOST:PORT, such as 127.0.0.1:3000 or [::1]:3000, with a port from 0 to 65535";
inline constexpr std::string_view kMustBeListenHost = "must be an address of this machine, such as 127.0.0.1 or ::1";

// Returns nullopt if `text` is not HOST:PORT. Port 0 is accepted: where it makes no sense, the caller refuses it.
std::optional<HostPort> parse_host_port(std::string_view text);

// HOST alone, without its brackets.
std::optional<std::string> parse_host(std::string_view text);

// HOST to listen on: an address in digits, without its brackets; "localhost" is 127.0.0.1. Whether it is an address of
// this machine is found out by listening.
std::optional<std::string> parse_listen_host(std::string_view text);

// With a zone or without, no brackets.
bool is_ipv6(std::string_view host);

// The two sides of the border; views into the text.
struct HostPortText {
  std::string_view host, port;
};

// For a port that may be the name of a service, such as "localhost:http", which the system's resolver reads. Returns
// nullopt if there is no host or no port.
std::optional<HostPortText> split_host_port(std::string_view text);

}  // namespace kenaf::protocol
