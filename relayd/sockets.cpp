#include "relayd/sockets.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace kenaf::relayd {

namespace {

using Clock = std::chrono::steady_clock;

// Holds one second of commands at 1 kHz if the relay is held up. The kernel may grant less.
constexpr int kReceiveBufferBytes = 1 << 20;

sockaddr_in to_sockaddr(const Address& address) {
  sockaddr_in out{};
  out.sin_family = AF_INET;
  out.sin_addr.s_addr = htonl(address.ipv4);
  out.sin_port = htons(address.port);
  return out;
}

// Returns 0, or the errno of the failed connection.
int finish_connect(int fd, Clock::time_point until, int cancel_fd) {
  std::array<pollfd, 2> watched{{{fd, POLLOUT, 0}, {cancel_fd, POLLIN, 0}}};
  const int ready = ::poll(watched.data(), watched.size(), poll_timeout(until));
  if (ready < 0) return errno;
  if (watched[0].revents == 0) return ready == 0 ? ETIMEDOUT : ECANCELED;
  int error = 0;
  socklen_t size = sizeof error;
  ::getsockopt(fd, SOL_SOCKET, SO_ERROR, &error, &size);
  return error;
}

}  // namespace

Descriptor::~Descriptor() {
  if (fd_ >= 0) ::close(fd_);
}

std::string to_text(const Address& address) {
  return fmt::format("{}.{}.{}.{}:{}", address.ipv4 >> 24, (address.ipv4 >> 16) & 0xff, (address.ipv4 >> 8) & 0xff,
                     address.ipv4 & 0xff, address.port);
}

bool is_loopback(const Address& address) {
  return (address.ipv4 >> 24) == 127;
}

protocol::HostPort parse_server(std::string_view text) {
  std::optional<protocol::HostPort> parsed = protocol::parse_host_port(text);
  if (!parsed) throw std::runtime_error(fmt::format("'{}' is not HOST:PORT with a port from 0 to 65535", text));
  return *std::move(parsed);
}

Address parse_address(std::string_view text) {
  const protocol::HostPort parsed = parse_server(text);
  in_addr ipv4{};
  if (::inet_pton(AF_INET, parsed.host == "localhost" ? "127.0.0.1" : parsed.host.c_str(), &ipv4) != 1) {
    throw std::runtime_error(fmt::format("'{}' is not an IPv4 address such as 127.0.0.1", parsed.host));
  }
  return {ntohl(ipv4.s_addr), parsed.port};
}

Descriptor open_udp(const Address& address, Address& bound) {
  Descriptor fd(::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  const sockaddr_in wanted = to_sockaddr(address);
  if (fd.get() < 0 || ::bind(fd.get(), reinterpret_cast<const sockaddr*>(&wanted), sizeof wanted) != 0) {
    throw std::runtime_error(fmt::format("cannot listen on UDP {}: {}; choose another address with --listen",
                                         to_text(address), std::strerror(errno)));
  }
  ::setsockopt(fd.get(), SOL_SOCKET, SO_RCVBUF, &kReceiveBufferBytes, sizeof kReceiveBufferBytes);
  sockaddr_in got{};
  socklen_t size = sizeof got;
  ::getsockname(fd.get(), reinterpret_cast<sockaddr*>(&got), &size);
  bound = {ntohl(got.sin_addr.s_addr), ntohs(got.sin_port)};
  return fd;
}

int poll_timeout(Clock::time_point until) {
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now()).count();
  return static_cast<int>(std::clamp<std::int64_t>(left, 0, 60000));
}

std::optional<Descriptor> connect_tcp(std::span<const Endpoint> endpoints, Clock::time_point deadline, int cancel_fd) {
  int error = EADDRNOTAVAIL;
  for (std::size_t i = 0; i < endpoints.size(); ++i) {
    const Endpoint& endpoint = endpoints[i];
    Descriptor fd(::socket(endpoint.address.ss_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
    error = fd.get() < 0 ? errno : 0;
    if (error == 0 && ::connect(fd.get(), reinterpret_cast<const sockaddr*>(&endpoint.address), endpoint.size) != 0) {
      // a silent address leaves each of the following ones the same share of the time
      const Clock::time_point now = Clock::now();
      const Clock::time_point until = now + (deadline - now) / static_cast<std::int64_t>(endpoints.size() - i);
      error = errno == EINPROGRESS ? finish_connect(fd.get(), until, cancel_fd) : errno;
    }
    if (error == ECANCELED) return std::nullopt;
    if (error != 0) continue;
    const int on = 1;
    ::setsockopt(fd.get(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    return fd;
  }
  throw std::runtime_error(std::strerror(error));
}

}  // namespace kenaf::relayd
