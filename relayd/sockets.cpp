#include "relayd/sockets.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <net/if.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <stdexcept>

namespace kenaf::relayd {

namespace {

using Clock = std::chrono::steady_clock;

// Holds one second of commands at 1 kHz if the relay is held up. The kernel may grant less.
constexpr int kReceiveBufferBytes = 1 << 20;

constexpr std::array<std::uint8_t, 12> kIpv4Prefix{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xff, 0xff};

// The index of the interface that a zone names; 0: there is none.
std::uint32_t zone_index(const std::string& zone) {
  std::uint32_t index = 0;
  const auto [end, error] = std::from_chars(zone.data(), zone.data() + zone.size(), index);
  return error == std::errc{} && end == zone.data() + zone.size() ? index : ::if_nametoindex(zone.c_str());
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

bool is_ipv4(const Address& address) {
  return std::ranges::equal(kIpv4Prefix, std::span(address.ip).first<kIpv4Prefix.size()>());
}

std::string to_text(const Address& address) {
  const auto* const bytes = address.ip.data();
  std::array<char, INET6_ADDRSTRLEN> host{};
  if (is_ipv4(address))
    ::inet_ntop(AF_INET, bytes + kIpv4Prefix.size(), host.data(), host.size());
  else
    ::inet_ntop(AF_INET6, bytes, host.data(), host.size());
  const std::string zone = address.zone == 0 ? "" : fmt::format("%{}", address.zone);
  return protocol::to_text({host.data() + zone, address.port});
}

bool is_loopback(const Address& address) {
  if (is_ipv4(address)) return address.ip[kIpv4Prefix.size()] == 127;
  return std::ranges::equal(address.ip, in6addr_loopback.s6_addr);
}

Endpoint endpoint_of(const Address& address, int family) {
  Endpoint out;
  if (family == AF_INET) {
    sockaddr_in v4{};
    v4.sin_family = AF_INET;
    v4.sin_port = htons(address.port);
    std::memcpy(&v4.sin_addr, address.ip.data() + kIpv4Prefix.size(), sizeof v4.sin_addr);
    std::memcpy(&out.address, &v4, sizeof v4);
    out.size = sizeof v4;
  } else {
    sockaddr_in6 v6{};
    v6.sin6_family = AF_INET6;
    v6.sin6_port = htons(address.port);
    v6.sin6_scope_id = address.zone;
    std::memcpy(&v6.sin6_addr, address.ip.data(), sizeof v6.sin6_addr);
    std::memcpy(&out.address, &v6, sizeof v6);
    out.size = sizeof v6;
  }
  return out;
}

Address address_of(const sockaddr_storage& address) {
  Address out;
  if (address.ss_family == AF_INET) {
    sockaddr_in v4{};
    std::memcpy(&v4, &address, sizeof v4);
    std::ranges::copy(kIpv4Prefix, out.ip.begin());
    std::memcpy(out.ip.data() + kIpv4Prefix.size(), &v4.sin_addr, sizeof v4.sin_addr);
    out.port = ntohs(v4.sin_port);
  } else if (address.ss_family == AF_INET6) {
    sockaddr_in6 v6{};
    std::memcpy(&v6, &address, sizeof v6);
    std::memcpy(out.ip.data(), &v6.sin6_addr, sizeof v6.sin6_addr);
    out.port = ntohs(v6.sin6_port);
    out.zone = v6.sin6_scope_id;
  }
  return out;
}

protocol::HostPort parse_server(std::string_view text) {
  std::optional<protocol::HostPort> parsed = protocol::parse_host_port(text);
  if (!parsed) throw std::runtime_error(std::string(protocol::kMustBeHostPort));
  return *std::move(parsed);
}

Address parse_address(std::string_view text) {
  const std::optional<protocol::HostPort> parsed = protocol::parse_host_port(text);
  const std::optional<std::string> host = parsed ? protocol::parse_listen_host(parsed->host) : std::nullopt;
  if (!host) {
    throw std::runtime_error(
        "must be ADDRESS:PORT, such as 127.0.0.1:45454 or [::1]:45454, with an address of this machine and a port from "
        "0 to 65535");
  }
  Address out{{}, parsed->port};
  if (::inet_pton(AF_INET, host->c_str(), out.ip.data() + kIpv4Prefix.size()) == 1) {
    std::ranges::copy(kIpv4Prefix, out.ip.begin());
    return out;
  }
  const std::size_t percent = host->find('%');
  ::inet_pton(AF_INET6, host->substr(0, percent).c_str(), out.ip.data());
  if (percent == std::string::npos) return out;
  out.zone = zone_index(host->substr(percent + 1));
  if (out.zone == 0)
    throw std::runtime_error(
        fmt::format("must name a network interface after the %: there is no '{}' here", host->substr(percent + 1)));
  return out;
}

Descriptor open_udp(const Address& address, Address& bound) {
  const int family = is_ipv4(address) ? AF_INET : AF_INET6;
  Descriptor fd(::socket(family, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  const int off = 0;
  // whatever the system's default is (net.ipv6.bindv6only)
  if (fd.get() >= 0 && family == AF_INET6) ::setsockopt(fd.get(), IPPROTO_IPV6, IPV6_V6ONLY, &off, sizeof off);
  const Endpoint wanted = endpoint_of(address, family);
  if (fd.get() < 0 || ::bind(fd.get(), reinterpret_cast<const sockaddr*>(&wanted.address), wanted.size) != 0) {
    throw std::runtime_error(fmt::format("cannot listen on UDP {}: {}; choose another address with --listen",
                                         to_text(address), std::strerror(errno)));
  }
  ::setsockopt(fd.get(), SOL_SOCKET, SO_RCVBUF, &kReceiveBufferBytes, sizeof kReceiveBufferBytes);
  protocol::tell_reached_addresses(fd.get(), family);
  sockaddr_storage got{};
  socklen_t size = sizeof got;
  ::getsockname(fd.get(), reinterpret_cast<sockaddr*>(&got), &size);
  bound = address_of(got);
  return fd;
}

std::optional<std::size_t> receive_from(int fd, std::span<std::byte> bytes, Peer& from) {
  sockaddr_storage address{};
  socklen_t size = 0;
  const auto got = protocol::receive_datagram(fd, bytes, address, size, from.reached);
  if (got) from.address = address_of(address);
  return got;
}

void send_to(int fd, int family, std::span<const std::byte> bytes, const Peer& to) {
  const Endpoint endpoint = endpoint_of(to.address, family);
  protocol::send_datagram(fd, bytes, reinterpret_cast<const sockaddr*>(&endpoint.address), endpoint.size, to.reached);
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
