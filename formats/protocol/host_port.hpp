// HOST:PORT, by which command lines and configurations name the other end of a connection.
//
// Grammar: the last colon is the border, so that an IPv6 address may stand with or without its brackets.
//   HOST  a name or an address, not empty; one pair of brackets around it is taken off: "[::1]" is the host "::1"
//   PORT  of parse_host_port(): decimal digits alone, 0 to 65535; of split_host_port(): any text, not empty
// Whether there is such a host is for the caller to find out: nothing here asks a name server, and every other
// character of a host is taken as it stands.
//
//   "127.0.0.1:45454"   "localhost:0"   "robot.example:3000"   "[fe80::1]:80"   "::1:80"
//
// Refused: "localhost", "localhost:", ":80", "[]:80", "host:70000", "host:-1", "host: 80".
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

// Returns nullopt if `text` is not HOST:PORT. Port 0 is accepted: where it makes no sense, the caller refuses it.
std::optional<HostPort> parse_host_port(std::string_view text);

// The two sides of the border; views into the text.
struct HostPortText {
  std::string_view host, port;
};

// For a port that may be the name of a service, such as "localhost:http", which the system's resolver reads. Returns
// nullopt if there is no colon or one side is empty.
std::optional<HostPortText> split_host_port(std::string_view text);

}  // namespace kenaf::protocol
