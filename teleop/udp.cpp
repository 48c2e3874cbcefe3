#include "udp.hpp"

#include <fmt/format.h>
#include <netdb.h>
#include <netinet/in.h>
#include <unistd.h>

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

Peer resolve(const std::string& host_port) {
  const auto sides = protocol::split_host_port(host_port);
  if (!sides) throw std::runtime_error(fmt::format("'{}' is not HOST:PORT", host_port));
  const std::string host(sides->host), port(sides->port);
  addrinfo hints{};
  hints.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  const int error = ::getaddrinfo(host.c_str(), port.c_str(), &hints, &found);
  if (error != 0) throw std::runtime_error(fmt::format("cannot find '{}': {}", host_port, ::gai_strerror(error)));
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> owned(found, &::freeaddrinfo);
  Peer peer;
  std::memcpy(&peer.address, found->ai_addr, found->ai_addrlen);
  peer.size = found->ai_addrlen;
  return peer;
}

UdpSocket::UdpSocket(int family) : descriptor_(::socket(family, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)) {
  if (descriptor_ < 0) throw std::runtime_error(fmt::format("cannot open a UDP socket: {}", std::strerror(errno)));
}

UdpSocket UdpSocket::bound_to(const Peer& local) {
  UdpSocket socket(local.address.ss_family);
  if (::bind(socket.descriptor_, plain(local), local.size) != 0) {
    throw std::runtime_error(fmt::format("cannot listen on {}: {}", to_text(local), std::strerror(errno)));
  }
  return socket;
}

UdpSocket UdpSocket::connected_to(const Peer& remote) {
  UdpSocket socket(remote.address.ss_family);
  if (::connect(socket.descriptor_, plain(remote), remote.size) != 0) {
    throw std::runtime_error(fmt::format("no way to {}: {}", to_text(remote), std::strerror(errno)));
  }
  return socket;
}

UdpSocket::~UdpSocket() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

UdpSocket::UdpSocket(UdpSocket&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}

std::uint16_t UdpSocket::port() const {
  Peer own;
  own.size = sizeof own.address;
  if (::getsockname(descriptor_, reinterpret_cast<sockaddr*>(&own.address), &own.size) != 0) return 0;
  // the port is at the same offset in the addresses of both families
  return ntohs(reinterpret_cast<const sockaddr_in&>(own.address).sin_port);
}

std::optional<std::size_t> UdpSocket::receive(std::span<std::byte> buffer, Peer& from) const {
  from.size = sizeof from.address;
  ssize_t got = -1;
  do {
    // an error here is a delayed report about an earlier datagram that nobody received (ECONNREFUSED), not a datagram
    got = ::recvfrom(descriptor_, buffer.data(), buffer.size(), 0, reinterpret_cast<sockaddr*>(&from.address),
                     &from.size);
  } while (got < 0 && (errno == ECONNREFUSED || errno == EINTR));
  if (got < 0) return std::nullopt;
  return static_cast<std::size_t>(got);
}

void UdpSocket::send(std::span<const std::byte> datagram, const Peer& to) const {
  (void)::sendto(descriptor_, datagram.data(), datagram.size(), MSG_NOSIGNAL, plain(to), to.size);
}

void UdpSocket::send(std::span<const std::byte> datagram) const {
  (void)::send(descriptor_, datagram.data(), datagram.size(), MSG_NOSIGNAL);
}

}  // namespace kenaf::teleop
