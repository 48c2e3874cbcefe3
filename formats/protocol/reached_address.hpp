// Which of this machine's addresses a UDP datagram was sent to. The answer has to come from there: a peer whose socket
// is connected takes it from no other address, and a socket that listens on 0.0.0.0 or [::] would answer from any that
// leads to the peer.
//
// Thread safety: pure functions and system calls. Nothing here allocates or waits.
#pragma once

#include <netinet/in.h>
#include <sys/socket.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace kenaf::protocol {

struct ReachedAddress {
  int family = AF_UNSPEC;  // of the socket; AF_UNSPEC: unknown, the system chooses
  in_addr ipv4{};
  in6_addr ipv6{};         // of a socket of IPv6 also IPv4, "::ffff:127.0.0.1"
  std::uint32_t zone = 0;  // of a link-local ipv6: the interface's index
};

// A UDP socket of `family` tells the addresses from now on. What cannot be told stays unknown.
void tell_reached_addresses(int fd, int family);

// Reads the next datagram, cut to `bytes`. Returns its size; nullopt, with errno: there is none.
std::optional<std::size_t> receive_datagram(int fd, std::span<std::byte> bytes, sockaddr_storage& from,
                                            socklen_t& from_size, ReachedAddress& reached);
// Sends from `reached`; if nothing can be sent from there, from where the system chooses. A datagram that cannot be
// sent is lost.
void send_datagram(int fd, std::span<const std::byte> bytes, const sockaddr* to, socklen_t to_size,
                   const ReachedAddress& reached);

}  // namespace kenaf::protocol
