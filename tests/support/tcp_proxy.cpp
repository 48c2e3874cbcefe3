#include "tests/support/tcp_proxy.hpp"

#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <stdexcept>
#include <system_error>

#include "tests/support/loopback.hpp"

namespace kenaf::support {

TcpProxy::TcpProxy(std::uint16_t server_port, std::chrono::milliseconds each_way)
    : listener_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)), each_way_(each_way), server_port_(server_port) {
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
    ::close(pair.there.from);
    ::close(pair.there.to);
  }
  ::close(listener_);
}

void TcpProxy::accept() {
  const int client = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
  if (client < 0) return;
  try {
    const int server = test::connect_to_loopback(server_port_);
    pairs_.push_back({{client, server}, {server, client}});
  } catch (const std::runtime_error&) {  // no server at present
    ::close(client);
  }
}

void TcpProxy::take(Way& way) {
  std::array<char, 16384> bytes;
  const ssize_t count = ::recv(way.from, bytes.data(), bytes.size(), 0);
  way.has_ended = count <= 0;
  way.under_way.push_back(
      {Clock::now() + each_way_, std::string(bytes.data(), static_cast<std::size_t>(std::max<ssize_t>(0, count)))});
}

bool TcpProxy::deliver(Way& way, Clock::time_point now) {
  while (!way.under_way.empty() && way.under_way.front().due <= now) {
    const std::string& bytes = way.under_way.front().bytes;
    if (bytes.empty() || !test::send_all(way.to, bytes)) return false;
    way.under_way.pop_front();
  }
  return true;
}

// Until the next piece is due, and not longer than until cut() and the end are to be noticed.
int TcpProxy::wait_ms() const {
  constexpr std::int64_t kLookAgain_ms = 5;
  std::int64_t wait = kLookAgain_ms;
  for (const Pair& pair : pairs_) {
    for (const Way* way : {&pair.there, &pair.back}) {
      if (way->under_way.empty()) continue;
      const auto left = std::chrono::ceil<std::chrono::milliseconds>(way->under_way.front().due - Clock::now());
      wait = std::clamp<std::int64_t>(left.count(), 0, wait);
    }
  }
  return static_cast<int>(wait);
}

void TcpProxy::run() {
  while (!stopping_) {
    if (cuts_.exchange(false)) {
      for (Pair& pair : pairs_) pair.is_cut = true;
    }
    std::vector<pollfd> watched{{listener_, POLLIN, 0}};
    for (const Pair& pair : pairs_) {
      for (const Way* way : {&pair.there, &pair.back}) {
        watched.push_back({pair.is_cut || way->has_ended ? -1 : way->from, POLLIN, 0});
      }
    }
    if (::poll(watched.data(), watched.size(), wait_ms()) < 0) continue;
    // From the end, so that erasing does not move what is still to be looked at.
    for (std::size_t i = pairs_.size(); i-- > 0;) {
      Pair& pair = pairs_[i];
      if (pair.is_cut) continue;
      if (watched[2 * i + 1].revents != 0) take(pair.there);
      if (watched[2 * i + 2].revents != 0) take(pair.back);
      const Clock::time_point now = Clock::now();
      if (deliver(pair.there, now) && deliver(pair.back, now)) continue;
      ::close(pair.there.from);
      ::close(pair.there.to);
      pairs_.erase(pairs_.begin() + static_cast<std::ptrdiff_t>(i));
    }
    if (watched[0].revents != 0) accept();
  }
}

}  // namespace kenaf::support
