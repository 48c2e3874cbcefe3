// A UDP socket, IPv4 or IPv6, that never blocks and never fails on what the network does: a datagram that cannot be
// sent is one that was lost. Thread safety: a socket belongs to one thread.
#pragma once

#include <sys/socket.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace kenaf::teleop {

// Where a datagram came from or goes to.
struct Peer {
  sockaddr_storage address{};
  socklen_t size = 0;
};
std::string to_text(const Peer& peer);  // "10.0.0.5:45460"

// "HOST:PORT", "[V6]:PORT"; names are looked up. Throws std::runtime_error with words for a user.
Peer resolve(const std::string& host_port);

class UdpSocket {
 public:
  // For whoever is to be found: bound to `local`; port 0 takes a free one. Throws std::runtime_error.
  static UdpSocket bound_to(const Peer& local);
  // For whoever looks for `remote`: hears nobody else. Throws std::runtime_error.
  static UdpSocket connected_to(const Peer& remote);
  ~UdpSocket();
  UdpSocket(UdpSocket&& other) noexcept;
  UdpSocket& operator=(UdpSocket&&) = delete;

  int descriptor() const { return descriptor_; }
  std::uint16_t port() const;

  // One datagram that has come, cut to `buffer`; nullopt: none is there.
  std::optional<std::size_t> receive(std::span<std::byte> buffer, Peer& from) const;
  void send(std::span<const std::byte> datagram, const Peer& to) const;
  void send(std::span<const std::byte> datagram) const;  // of a connected one

 private:
  explicit UdpSocket(int family);
  int descriptor_;
};

}  // namespace kenaf::teleop
