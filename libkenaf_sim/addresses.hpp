// The addresses of a HOST:PORT of the configuration (formats/protocol/host_port.hpp). Thread safety: any thread; the
// system's name service may block for seconds.
#pragma once

#include <netdb.h>

#include <memory>
#include <string>

namespace kenaf::sim {

using Addresses = std::unique_ptr<addrinfo, decltype(&freeaddrinfo)>;

// `key`: the configuration's, for messages. `socket_type`: SOCK_DGRAM or SOCK_STREAM. Returns at least one address.
// Throws Error(HRT_E_CONFIG) if `host_port` is not HOST:PORT with a port from 1 to 65535, or if there is no such host.
Addresses look_up(const char* key, const std::string& host_port, int socket_type);

}  // namespace kenaf::sim
