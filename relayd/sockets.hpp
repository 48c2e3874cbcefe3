// POSIX sockets: owned descriptors, IPv4 addresses, and the ways in which the relay opens sockets. Functions throw
// std::runtime_error with a text for the user unless stated otherwise.
#pragma once

#include <sys/socket.h>

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "formats/protocol/host_port.hpp"

namespace kenaf::relayd {

// Owns a file descriptor.
class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor();
  Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  int get() const { return fd_; }

 private:
  int fd_ = -1;
};

// An IPv4 address and port, in host byte order.
struct Address {
  std::uint32_t ipv4 = 0;
  std::uint16_t port = 0;
  bool operator==(const Address&) const = default;
};
std::string to_text(const Address& address);  // "127.0.0.1:45454"
bool is_loopback(const Address& address);

// HOST:PORT, also "[v6]:PORT", as formats/protocol/host_port.hpp; port 0 is accepted.
protocol::HostPort parse_server(std::string_view text);
// The same, restricted to a dotted IPv4 address or "localhost".
Address parse_address(std::string_view text);

// Returns a bound, non-blocking UDP socket; `bound` becomes its address.
Descriptor open_udp(const Address& address, Address& bound);

// For poll(): milliseconds until `until`, rounded up so that poll() does not return just before it; a minute at most.
int poll_timeout(std::chrono::steady_clock::time_point until);

// An address for connect(), of any family.
struct Endpoint {
  sockaddr_storage address{};
  socklen_t size = 0;
};

// Connects by TCP to the first of `endpoints` that accepts; the socket is non-blocking, with TCP_NODELAY. Waits until
// `deadline` at most, shared among the endpoints. Returns nullopt once `cancel_fd` is readable, which says nothing
// about the server.
std::optional<Descriptor> connect_tcp(std::span<const Endpoint> endpoints,
                                      std::chrono::steady_clock::time_point deadline, int cancel_fd);

}  // namespace kenaf::relayd
