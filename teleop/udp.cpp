#include "udp.hpp"

#include <fmt/format.h>
#include <netdb.h>
#include <netinet/in.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <utility>

#include "formats/protocol/host_port.hpp"

namespace kenaf::teleop {

namespace {

const sockaddr* plain(const Peer& peer) {
  return reinterpret_cast<const sockaddr*>(&peer.address);
}

// Returns -1 with errno if there is none, as of IPv6 where the machine has it not.
int new_socket(int family) {
  return ::socket(family, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
}

}  // namespace

std::string to_text(const Peer& peer) {
  std::array<char, NI_MAXHOST> host{};
  std::array<char, NI_MAXSERV> port{};
  if (::getnameinfo(plain(peer), peer.size, host.data(), host.size(), port.data(), port.size(),
                    NI_NUMERICHOST | NI_NUMERICSERV) != 0) {
    return "an unknown address";
  }
  const bool is_v6 = peer.address.ss_family == AF_INET6;
  return fmt::format("{}{}{}:{}", is_v6 ? "[" : "", host.data(), is_v6 ? "]" : "", port.data());
}

void require_host_port(const std::string& host_port) {
  const auto sides = protocol::split_host_port(host_port);
  // a port in digits is checked, the name of a service is for the system
  const bool in_digits = sides && sides->port.find_first_not_of("0123456789+-.") == std::string_view::npos;
  if (!sides || (in_digits && !protocol::parse_host_port(host_port)))
    throw std::runtime_error(std::string(protocol::kMustBeHostPort));
}

std::vector<Peer> resolve(const std::string& host_port) {
  const auto sides = protocol::split_host_port(host_port);
  if (!sides) throw std::runtime_error(fmt::format("'{}' {}", host_port, protocol::kMustBeHostPort));
  const std::string host(sides->host), port(sides->port);
  addrinfo hints{};
  hints.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  const int error = ::getaddrinfo(host.c_str(), port.c_str(), &hints, &found);
  if (error != 0) throw std::runtime_error(fmt::format("cannot find '{}': {}", host_port, ::gai_strerror(error)));
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> owned(found, &::freeaddrinfo);
  std::vector<Peer> peers;
  for (const addrinfo* at = found; at != nullptr; at = at->ai_next) {
    Peer& peer = peers.emplace_back();
    std::memcpy(&peer.address, at->ai_addr, at->ai_addrlen);
    peer.size = at->ai_addrlen;
  }
  return peers;
}

Peer resolve_listener(const std::string& host_port) {
  const std::vector<Peer> peers = resolve(host_port);
  const auto v4 = std::ranges::find(peers, AF_INET, [](const Peer& peer) { return peer.address.ss_family; });
  return v4 == peers.end() ? peers.front() : *v4;
}

UdpSocket UdpSocket::bound_to(const Peer& local) {
  UdpSocket socket(new_socket(local.address.ss_family));
  if (socket.descriptor_ < 0)
    throw std::runtime_error(fmt::format("cannot open a UDP socket: {}", std::strerror(errno)));
  if (::bind(socket.descriptor_, plain(local), local.size) != 0) {
    throw std::runtime_error(fmt::format("cannot listen on {}: {}", to_text(local), std::strerror(errno)));
  }
  protocol::tell_reached_addresses(socket.descriptor_, local.address.ss_family);
  return socket;
}

UdpSocket UdpSocket::connected_to(const std::vector<Peer>& remotes) {
  std::string why;
  for (std::size_t i = 0; i < remotes.size(); ++i) {
    UdpSocket socket(new_socket(remotes[i].address.ss_family));
    if (socket.descriptor_ >= 0 && ::connect(socket.descriptor_, plain(remotes[i]), remotes[i].size) == 0) {
      if (remotes.size() > 1) socket.remotes_ = remotes;
      socket.remote_ = i;
      return socket;
    }
    why = fmt::format("no way to {}: {}", to_text(remotes[i]), std::strerror(errno));
  }
  throw std::runtime_error(why);
}

// To one that there is no way to, nothing is sent and nothing comes from it: the next refusal, or none, decides.
void UdpSocket::connect_to_next() {
  for (std::size_t tried = 0; tried < remotes_.size(); ++tried) {
    remote_ = (remote_ + 1) % remotes_.size();
    const Peer& remote = remotes_[remote_];
    const int next = new_socket(remote.address.ss_family);
    if (next >= 0 && ::connect(next, plain(remote), remote.size) == 0) {
      ::close(std::exchange(descriptor_, next));
      return;
    }
    if (next >= 0) ::close(next);
  }
}

UdpSocket::~UdpSocket() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

UdpSocket::UdpSocket(UdpSocket&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)), remotes_(std::move(other.remotes_)), remote_(other.remote_) {}

std::uint16_t UdpSocket::port() const {
  Peer own;
  own.size = sizeof own.address;
  if (::getsockname(descriptor_, reinterpret_cast<sockaddr*>(&own.address), &own.size) != 0) return 0;
  // the port is at the same offset in the addresses of both families
  return ntohs(reinterpret_cast<const sockaddr_in&>(own.address).sin_port);
}

std::optional<std::size_t> UdpSocket::receive(std::span<std::byte> buffer, Peer& from) {
  std::optional<std::size_t> got;
  do {
    // an error here is a delayed report about an earlier datagram that nobody received (ECONNREFUSED), not a datagram
    got = protocol::receive_datagram(descriptor_, buffer, from.address, from.size, from.reached);
    if (!got && errno == ECONNREFUSED && !remotes_.empty()) {
      connect_to_next();
      return std::nullopt;
    }
  } while (!got && (errno == ECONNREFUSED || errno == EINTR));
  if (got) remotes_.clear();
  return got;
}

void UdpSocket::send(std::span<const std::byte> datagram, const Peer& to) const {
  protocol::send_datagram(descriptor_, datagram, plain(to), to.size, to.reached);
}

void UdpSocket::send(std::span<const std::byte> datagram) {
  const ssize_t sent = ::send(descriptor_, datagram.data(), datagram.size(), MSG_NOSIGNAL);
  if (sent < 0 && errno == ECONNREFUSED && !remotes_.empty()) connect_to_next();
}

}  // namespace kenaf::teleop
