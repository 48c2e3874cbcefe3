// Parses and resolves HOST:PORT of the configuration. Thread safety: pure, except for the name service, which may block
// for seconds.
#pragma once

#include <netdb.h>

#include <memory>
#include <string>

namespace kenaf::sim {

struct HostPort {
  std::string host;  // without the brackets of an IPv6 address; never empty
  std::string port;  // decimal digits: 1 to 65535
};

// `key`: the configuration's, for messages. "[::1]:45454" is an IPv6 address. Throws Error(HRT_E_CONFIG) if it is not
// HOST:PORT.
HostPort parse_host_port(const char* key, const std::string& host_port);

using Addresses = std::unique_ptr<addrinfo, decltype(&freeaddrinfo)>;

// `socket_type`: SOCK_DGRAM or SOCK_STREAM. Returns at least one address. Throws Error(HRT_E_CONFIG) as
// parse_host_port, or if there is no such host.
Addresses look_up(const char* key, const std::string& host_port, int socket_type);

}  // namespace kenaf::sim
