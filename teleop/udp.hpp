// A UDP socket, IPv4 or IPv6, that never blocks and never fails on network errors: a datagram that cannot be sent
// counts as lost. Thread safety: one socket, one thread.
#pragma once

#include <sys/socket.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace kenaf::teleop {

// Source or destination of a datagram.
struct Peer {
  sockaddr_storage address{};
  socklen_t size = 0;
};
std::string to_text(const Peer& peer);  // "10.0.0.5:45460"

// HOST:PORT (formats/protocol/host_port.hpp); names of hosts and services are resolved. Throws std::runtime_error with
// a text for the user.
Peer resolve(const std::string& host_port);

class UdpSocket {
 public:
  // A server socket bound to `local`; port 0 takes a free one. Throws std::runtime_error.
  static UdpSocket bound_to(const Peer& local);
  // A client socket that receives only from `remote`. Throws std::runtime_error.
  static UdpSocket connected_to(const Peer& remote);
  ~UdpSocket();
  UdpSocket(UdpSocket&& other) noexcept;
  UdpSocket& operator=(UdpSocket&&) = delete;

  int descriptor() const { return descriptor_; }
  std::uint16_t port() const;

  // Returns one received datagram, truncated to `buffer`; nullopt if there is none.
  std::optional<std::size_t> receive(std::span<std::byte> buffer, Peer& from) const;
  void send(std::span<const std::byte> datagram, const Peer& to) const;
  void send(std::span<const std::byte> datagram) const;  // for a connected socket

 private:
  explicit UdpSocket(int family);
  int descriptor_;
};

}  // namespace kenaf::teleop
