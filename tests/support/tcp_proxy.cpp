#include "tests/support/tcp_proxy.hpp"

#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <stdexcept>
#include <system_error>

#include "tests/support/loopback.hpp"

namespace kenaf::support {

TcpProxy::TcpProxy(std::uint16_t server_port)
    : listener_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)), server_port_(server_port) {
  sockaddr_in address = test::loopback(0);
  socklen_t size = sizeof address;
  if (::bind(listener_, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0 || ::listen(listener_, 16) != 0 ||
      ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size) != 0) {
    throw std::system_error(errno, std::generic_category(), "proxy");
  }
  port_ = ntohs(address.sin_port);
  thread_ = std::thread([this] { run(); });
}

TcpProxy::~TcpProxy() {
  stopping_ = true;
  thread_.join();
  for (const Pair& pair : pairs_) {
    ::close(pair.client);
    ::close(pair.server);
  }
  ::close(listener_);
}

void TcpProxy::accept() {
  const int client = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
  if (client < 0) return;
  try {
    pairs_.push_back({client, test::connect_to_loopback(server_port_)});
  } catch (const std::runtime_error&) {  // no server at present
    ::close(client);
  }
}

bool TcpProxy::pass(int from, int to) {
  std::array<char, 16384> bytes;
  const ssize_t count = ::recv(from, bytes.data(), bytes.size(), 0);
  return count > 0 && test::send_all(to, {bytes.data(), static_cast<std::size_t>(count)});
}

void TcpProxy::run() {
  while (!stopping_) {
    if (cuts_.exchange(false)) {
      for (Pair& pair : pairs_) pair.is_cut = true;
    }
    std::vector<pollfd> watched{{listener_, POLLIN, 0}};
    for (const Pair& pair : pairs_) {
      watched.push_back({pair.is_cut ? -1 : pair.client, POLLIN, 0});
      watched.push_back({pair.is_cut ? -1 : pair.server, POLLIN, 0});
    }
    constexpr int kLookAgain_ms = 5;
    if (::poll(watched.data(), watched.size(), kLookAgain_ms) <= 0) continue;
    // From the end, so that erasing does not move what is still to be looked at.
    for (std::size_t i = pairs_.size(); i-- > 0;) {
      const auto [client, server, is_cut] = pairs_[i];
      bool open = true;
      if (watched[2 * i + 1].revents != 0) open = pass(client, server);
      if (open && watched[2 * i + 2].revents != 0) open = pass(server, client);
      if (open) continue;
      ::close(client);
      ::close(server);
      pairs_.erase(pairs_.begin() + static_cast<std::ptrdiff_t>(i));
    }
    if (watched[0].revents != 0) accept();
  }
}

}  // namespace kenaf::support
