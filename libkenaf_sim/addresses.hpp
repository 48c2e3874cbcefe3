// The addresses of a HOST:PORT of the configuration (formats/protocol/host_port.hpp), within a time limit: the system's
// own look-up (getaddrinfo) can be neither limited nor interrupted, and takes many seconds if no name server answers.
//
// Thread safety: pure functions. A look-up that is late goes on in a thread of its own, which uses only its own copies.
#pragma once

#include <sys/socket.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "formats/protocol/host_port.hpp"

namespace kenaf::sim {

using TimePoint = std::chrono::steady_clock::time_point;

// For connect(), of either family.
struct Address {
  sockaddr_storage address{};
  socklen_t size = 0;
  const sockaddr* plain() const { return reinterpret_cast<const sockaddr*>(&address); }
};
using Addresses = std::vector<Address>;

// Finds the addresses of a name, however long it takes; `socket_type`: SOCK_DGRAM or SOCK_STREAM. Returns 0, or the
// error code of getaddrinfo().
using AskForAddresses = std::function<int(const protocol::HostPort& name, int socket_type, Addresses& found)>;
int ask_system(const protocol::HostPort& name, int socket_type, Addresses& found);

// `key`: the configuration's, for messages. Returns at least one address; nullopt: `cancel_fd` became readable. An
// address in digits takes neither time nor a thread. Throws Error(HRT_E_CONFIG) if `host_port` is not HOST:PORT with a
// port from 1 to 65535, or if there is no such host, and Error(HRT_E_LINK) if no name server answers, at `deadline` at
// the latest.
std::optional<Addresses> look_up(const char* key, const std::string& host_port, int socket_type, TimePoint deadline,
                                 int cancel_fd, const AskForAddresses& ask = ask_system);

// When to give the first of `left` addresses up, so that a silent one leaves each of the others the same share of the
// time until `deadline`.
inline TimePoint end_of_share(TimePoint now, TimePoint deadline, std::size_t left) {
  return now + (deadline - now) / static_cast<std::int64_t>(left);
}

}  // namespace kenaf::sim
