#include "formats/protocol/reached_address.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

namespace kenaf::protocol {
namespace {

// Room for one note of a datagram, of either family.
struct Notes {
  alignas(
      cmsghdr) std::array<std::byte, std::max(CMSG_SPACE(sizeof(in_pktinfo)), CMSG_SPACE(sizeof(in6_pktinfo)))> bytes{};
};

ReachedAddress read_note(msghdr& message) {
  for (cmsghdr* note = CMSG_FIRSTHDR(&message); note != nullptr; note = CMSG_NXTHDR(&message, note)) {
    ReachedAddress out;
    if (note->cmsg_level == IPPROTO_IP && note->cmsg_type == IP_PKTINFO) {
      in_pktinfo info{};
      std::memcpy(&info, CMSG_DATA(note), sizeof info);
      out.family = AF_INET;
      out.ipv4 = info.ipi_spec_dst;  // this machine's own, also of a datagram to all
      return out;
    }
    if (note->cmsg_level == IPPROTO_IPV6 && note->cmsg_type == IPV6_PKTINFO) {
      in6_pktinfo info{};
      std::memcpy(&info, CMSG_DATA(note), sizeof info);
      if (IN6_IS_ADDR_MULTICAST(&info.ipi6_addr)) return {};
      out.family = AF_INET6;
      out.ipv6 = info.ipi6_addr;
      if (IN6_IS_ADDR_LINKLOCAL(&info.ipi6_addr)) out.zone = info.ipi6_ifindex;
      return out;
    }
  }
  return {};
}

template <typename Info>
void write_note(msghdr& message, Notes& notes, int level, int type, const Info& info) {
  message.msg_control = notes.bytes.data();
  message.msg_controllen = CMSG_SPACE(sizeof info);
  cmsghdr* note = CMSG_FIRSTHDR(&message);
  note->cmsg_level = level;
  note->cmsg_type = type;
  note->cmsg_len = CMSG_LEN(sizeof info);
  std::memcpy(CMSG_DATA(note), &info, sizeof info);
}

}  // namespace

void tell_reached_addresses(int fd, int family) {
  const int on = 1;
  if (family == AF_INET) ::setsockopt(fd, IPPROTO_IP, IP_PKTINFO, &on, sizeof on);
  if (family == AF_INET6) ::setsockopt(fd, IPPROTO_IPV6, IPV6_RECVPKTINFO, &on, sizeof on);
}

std::optional<std::size_t> receive_datagram(int fd, std::span<std::byte> bytes, sockaddr_storage& from,
                                            socklen_t& from_size, ReachedAddress& reached) {
  Notes notes;
  iovec room{bytes.data(), bytes.size()};
  msghdr message{};
  message.msg_name = &from;
  message.msg_namelen = sizeof from;
  message.msg_iov = &room;
  message.msg_iovlen = 1;
  message.msg_control = notes.bytes.data();
  message.msg_controllen = notes.bytes.size();
  const ssize_t got = ::recvmsg(fd, &message, MSG_DONTWAIT);
  if (got < 0) return std::nullopt;
  from_size = message.msg_namelen;
  reached = read_note(message);
  return static_cast<std::size_t>(got);
}

void send_datagram(int fd, std::span<const std::byte> bytes, const sockaddr* to, socklen_t to_size,
                   const ReachedAddress& reached) {
  Notes notes;
  iovec content{const_cast<std::byte*>(bytes.data()), bytes.size()};
  msghdr message{};
  message.msg_name = const_cast<sockaddr*>(to);
  message.msg_namelen = to_size;
  message.msg_iov = &content;
  message.msg_iovlen = 1;
  if (reached.family == AF_INET) {
    in_pktinfo info{};
    info.ipi_spec_dst = reached.ipv4;
    write_note(message, notes, IPPROTO_IP, IP_PKTINFO, info);
  } else if (reached.family == AF_INET6) {
    write_note(message, notes, IPPROTO_IPV6, IPV6_PKTINFO, in6_pktinfo{reached.ipv6, reached.zone});
  }
  if (::sendmsg(fd, &message, MSG_DONTWAIT | MSG_NOSIGNAL) >= 0 || errno != EINVAL || message.msg_controllen == 0)
    return;
  message.msg_control = nullptr;  // from an address of all, or one that is gone, nothing is sent
  message.msg_controllen = 0;
  ::sendmsg(fd, &message, MSG_DONTWAIT | MSG_NOSIGNAL);
}

}  // namespace kenaf::protocol
