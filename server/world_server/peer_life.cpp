#include "server/world_server/peer_life.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <algorithm>

namespace kenaf::world_server {

namespace {

constexpr int kProbeEvery_s = 1;

void set_option(int socket, int level, int option, int value) {
  ::setsockopt(socket, level, option, &value, sizeof value);  // a socket that is gone already shows at its first read
}

}  // namespace

void end_with_peer(int socket) {
  set_option(socket, SOL_SOCKET, SO_KEEPALIVE, 1);
  set_option(socket, IPPROTO_TCP, TCP_KEEPIDLE, kProbeEvery_s);
  set_option(socket, IPPROTO_TCP, TCP_KEEPINTVL, kProbeEvery_s);
  set_option(socket, IPPROTO_TCP, TCP_KEEPCNT, static_cast<int>(kPeerGone_s) / kProbeEvery_s);
  set_option(socket, IPPROTO_TCP, TCP_USER_TIMEOUT, static_cast<int>(kPeerGone_s * 1000));
}

double unheard_of_s(int socket) {
  tcp_info info{};
  socklen_t size = sizeof info;
  if (::getsockopt(socket, IPPROTO_TCP, TCP_INFO, &info, &size) != 0) return 0;
  // A segment of nothing but data counts as data only.
  return std::min(info.tcpi_last_ack_recv, info.tcpi_last_data_recv) / 1000.0;
}

}  // namespace kenaf::world_server
