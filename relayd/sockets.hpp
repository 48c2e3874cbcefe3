// POSIX sockets: owned descriptors, IP addresses, and the ways in which the relay opens sockets. Functions throw
// std::runtime_error with a text for the user unless stated otherwise.
#pragma once

#include <sys/socket.h>

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "formats/protocol/host_port.hpp"
#include "formats/protocol/reached_address.hpp"

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

// An IP address and port. IPv4 is mapped into IPv6, "::ffff:127.0.0.1" (RFC 4291, section 2.5.5.2), as a socket of both
// families sees its peers: so a peer is the same at every socket.
struct Address {
  std::array<std::uint8_t, 16> ip{};
  std::uint16_t port = 0;
  std::uint32_t zone = 0;  // of a link-local IPv6 address: the interface's index; 0: none
  bool operator==(const Address&) const = default;
};
std::string to_text(const Address& address);  // "127.0.0.1:45454", "[::1]:45454"
bool is_loopback(const Address& address);
bool is_ipv4(const Address& address);

// HOST:PORT (formats/protocol/host_port.hpp); port 0 is accepted.
protocol::HostPort parse_server(std::string_view text);
// The same of an address to listen on: in digits, or "localhost", which is 127.0.0.1.
Address parse_address(std::string_view text);

// Returns a bound, non-blocking UDP socket; `bound` becomes its address. On [::] it gets the datagrams of both
// families.
Descriptor open_udp(const Address& address, Address& bound);

// Who sent a datagram, and to which address of this machine, from which an answer has to come.
struct Peer {
  Address address;
  protocol::ReachedAddress reached{};
};

// Of a socket from open_udp(), without waiting. Returns the size of the next datagram; nullopt: there is none.
std::optional<std::size_t> receive_from(int fd, std::span<std::byte> bytes, Peer& from);
// `family`: the socket's. A datagram that cannot be sent is lost.
void send_to(int fd, int family, std::span<const std::byte> bytes, const Peer& to);

// For poll(): milliseconds until `until`, rounded up so that poll() does not return just before it; a minute at most.
int poll_timeout(std::chrono::steady_clock::time_point until);

// An address for connect(), of any family.
struct Endpoint {
  sockaddr_storage address{};
  socklen_t size = 0;
};

// For the system's calls on a socket of a family, AF_INET or AF_INET6. Of AF_INET the address must be IPv4.
Endpoint endpoint_of(const Address& address, int family);
// Of either family; anything else is an empty address.
Address address_of(const sockaddr_storage& address);

// Connects by TCP to the first of `endpoints` that accepts; the socket is non-blocking, with TCP_NODELAY. Waits until
// `deadline` at most, shared among the endpoints. Returns nullopt once `cancel_fd` is readable, which says nothing
// about the server.
std::optional<Descriptor> connect_tcp(std::span<const Endpoint> endpoints,
                                      std::chrono::steady_clock::time_point deadline, int cancel_fd);

}  // namespace kenaf::relayd
