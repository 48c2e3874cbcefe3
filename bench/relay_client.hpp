// A client of the relay without the library on top, for benchmarks that time the chain itself.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>
#include <variant>

#include "formats/protocol/relay_datagram.hpp"

namespace kenaf::bench {

[[noreturn]] inline void fail(const std::string& what) {
  throw std::runtime_error(what + ": " + std::strerror(errno));
}

inline sockaddr_in loopback(std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

inline int connected_socket(int type, std::uint16_t port) {
  const int fd = ::socket(AF_INET, type | SOCK_CLOEXEC, 0);
  const sockaddr_in address = loopback(port);
  if (fd < 0 || ::connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) fail("connect");
  const timeval limit{5, 0};
  ::setsockopt(fd, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
  const int on = 1;
  if (type == SOCK_STREAM) ::setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  return fd;
}

// A client of the relay. Thread safety: one thread may send while another waits.
class RelayClient {
 public:
  explicit RelayClient(std::uint16_t port) : fd_(connected_socket(SOCK_DGRAM, port)) {}
  ~RelayClient() {
    send(kenaf::protocol::relay::Bye{kSession});
    ::close(fd_);
  }
  RelayClient(const RelayClient&) = delete;
  RelayClient& operator=(const RelayClient&) = delete;

  void send(const kenaf::protocol::relay::Datagram& datagram) {
    std::array<std::byte, kenaf::protocol::relay::kMaxDatagramBytes> bytes;
    const std::size_t size = kenaf::protocol::relay::encode(datagram, bytes);
    if (::send(fd_, bytes.data(), size, 0) < 0) fail("send");
  }
  template <class Kind, class Accepts>
  Kind wait_for(Accepts accepts) {
    kenaf::protocol::relay::Datagram datagram;
    while (true) {
      const ssize_t got = ::recv(fd_, bytes_.data(), bytes_.size(), 0);
      if (got <= 0) fail("no answer from the relay");
      const std::span<const std::byte> view(bytes_.data(), static_cast<std::size_t>(got));
      if (kenaf::protocol::relay::decode(view, datagram) != kenaf::protocol::DecodeError::none) continue;
      if (const Kind* kind = std::get_if<Kind>(&datagram); kind != nullptr && accepts(*kind)) return *kind;
    }
  }
  // Becomes the commander; retries while the world server behind the relay is still starting.
  void greet(bool lockstep) {
    const kenaf::protocol::relay::Hello hello{kSession, 0.01, 0.5, lockstep, false};
    for (int tries = 0; tries < 100; ++tries) {
      send(hello);
      kenaf::protocol::relay::Datagram datagram;
      const ssize_t got = ::recv(fd_, bytes_.data(), bytes_.size(), 0);
      if (got <= 0) fail("no answer from the relay");
      const std::span<const std::byte> view(bytes_.data(), static_cast<std::size_t>(got));
      if (kenaf::protocol::relay::decode(view, datagram) == kenaf::protocol::DecodeError::none &&
          std::holds_alternative<kenaf::protocol::relay::Welcome>(datagram)) {
        return;
      }
      ::usleep(50000);
    }
    throw std::runtime_error("the relay refuses");
  }
  static constexpr std::uint64_t kSession = 0x6b656e6166;

 private:
  int fd_;
  std::array<std::byte, kenaf::protocol::relay::kMaxDatagramBytes> bytes_;
};

}  // namespace kenaf::bench
