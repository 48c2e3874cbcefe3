// Plain POSIX sockets: owned descriptors, IPv4 addresses, and the few ways the relay opens a socket.
// Functions throw std::runtime_error with words for a user unless they say otherwise.
#pragma once

#include <sys/socket.h>

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

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

struct HostPort {
  std::string host;
  std::uint16_t port = 0;
};
// "HOST:PORT", also "[v6]:PORT".
HostPort parse_host_port(std::string_view text);
// The same where the host is a dotted IPv4 address or "localhost".
Address parse_address(std::string_view text);

// A bound UDP socket that does not block; `bound` becomes the address it got.
Descriptor open_udp(const Address& address, Address& bound);

// For poll(): milliseconds until then, rounded up so that it does not return just before the time; a minute at most.
int poll_timeout(std::chrono::steady_clock::time_point until);

// What connect() takes, of whatever family.
struct Endpoint {
  sockaddr_storage address{};
  socklen_t size = 0;
};

// A TCP connection to the first of `endpoints` that takes it, which does not block, with TCP_NODELAY. Waits until
// `deadline` at most, shared among the endpoints, and no longer once `cancel_fd` is readable: nullopt, which says
// nothing about the server.
std::optional<Descriptor> connect_tcp(std::span<const Endpoint> endpoints,
                                      std::chrono::steady_clock::time_point deadline, int cancel_fd);

}  // namespace kenaf::relayd
