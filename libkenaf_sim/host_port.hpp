// HOST:PORT of the configuration, looked up. Thread safety: pure, but for the name service, which may block for seconds.
#pragma once

#include <netdb.h>

#include <memory>
#include <string>

namespace kenaf::sim {

using Addresses = std::unique_ptr<addrinfo, decltype(&freeaddrinfo)>;

// `key`: the configuration's, for messages; `socket_type`: SOCK_DGRAM or SOCK_STREAM. "[::1]:45454" is an IPv6 address. At least one
// address. Throws Error(HRT_E_CONFIG): not HOST:PORT, or no such host.
Addresses look_up(const char* key, const std::string& host_port, int socket_type);

}  // namespace kenaf::sim
