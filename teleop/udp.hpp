// A UDP socket, IPv4 or IPv6, that never blocks and never fails on network errors: a datagram that cannot be sent
// counts as lost. Thread safety: one socket, one thread.
#pragma once

#include <sys/socket.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "formats/protocol/reached_address.hpp"

namespace kenaf::teleop {

// Source or destination of a datagram.
struct Peer {
  sockaddr_storage address{};
  socklen_t size = 0;
  protocol::ReachedAddress reached{};  // of a source: this machine's address, from which an answer comes
};
std::string to_text(const Peer& peer);  // "10.0.0.5:45460"

// HOST:PORT (formats/protocol/host_port.hpp); names of hosts and services are resolved. Returns all addresses that the
// name has, at least one. Throws std::runtime_error with a text for the user.
std::vector<Peer> resolve(const std::string& host_port);
// Throws std::runtime_error, "must be HOST:PORT ...", if the text is not of that form. Asks no name server.
void require_host_port(const std::string& host_port);
// The address to listen on: of a name that has several, the first IPv4 one. "localhost" is so the same everywhere.
Peer resolve_listener(const std::string& host_port);

class UdpSocket {
 public:
  // A server socket bound to `local`; port 0 takes a free one. Throws std::runtime_error.
  static UdpSocket bound_to(const Peer& local);
  // A client socket that receives only from one of `remotes`, the addresses of a name: from the first one at which
  // somebody listens. Until somebody has answered, a refusal makes it go on to the next. Throws std::runtime_error if
  // there is a way to none of them.
  static UdpSocket connected_to(const std::vector<Peer>& remotes);
  ~UdpSocket();
  UdpSocket(UdpSocket&& other) noexcept;
  UdpSocket& operator=(UdpSocket&&) = delete;

  int descriptor() const { return descriptor_; }  // another one after a refusal
  std::uint16_t port() const;

  // Returns one received datagram, truncated to `buffer`; nullopt if there is none.
  std::optional<std::size_t> receive(std::span<std::byte> buffer, Peer& from);
  void send(std::span<const std::byte> datagram, const Peer& to) const;
  void send(std::span<const std::byte> datagram);  // for a connected socket

 private:
  explicit UdpSocket(int descriptor) : descriptor_(descriptor) {}
  void connect_to_next();

  int descriptor_;
  std::vector<Peer> remotes_;  // of a client that nobody has answered yet; else empty
  std::size_t remote_ = 0;
};

}  // namespace kenaf::teleop
