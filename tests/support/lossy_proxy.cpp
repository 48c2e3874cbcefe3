#include "tests/support/lossy_proxy.hpp"

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <random>
#include <system_error>
#include <utility>
#include <vector>

#include "tests/support/loopback.hpp"

namespace kenaf::support {

namespace {

using Clock = std::chrono::steady_clock;
using test::loopback;

struct Held {
  bool to_server;
  std::vector<std::byte> bytes;
  Clock::time_point due;
};

int checked(int result) {
  if (result < 0) throw std::system_error(errno, std::generic_category(), "lossy proxy");
  return result;
}

}  // namespace

LossyProxy::LossyProxy(std::uint16_t server_port, unsigned seed, const Network& network, ProxyHooks hooks)
    : client_side_(checked(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0))),
      server_side_(checked(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0))) {
  sockaddr_in own = loopback(0);
  socklen_t size = sizeof own;
  checked(::bind(client_side_, reinterpret_cast<sockaddr*>(&own), size));
  checked(::getsockname(client_side_, reinterpret_cast<sockaddr*>(&own), &size));
  port_ = ntohs(own.sin_port);
  const sockaddr_in server = loopback(server_port);
  checked(::connect(server_side_, reinterpret_cast<const sockaddr*>(&server), sizeof server));
  thread_ = std::thread([this, seed, network, hooks = std::move(hooks)] { run(seed, network, hooks); });
}

LossyProxy::~LossyProxy() {
  stopping_ = true;
  thread_.join();
  ::close(client_side_);
  ::close(server_side_);
}

void LossyProxy::run(unsigned seed, Network network, const ProxyHooks& hooks) {
  if (hooks.at_start) hooks.at_start();
  std::mt19937 random(seed);
  const auto share = [&] { return std::uniform_real_distribution<double>()(random); };
  std::vector<Held> held;
  sockaddr_in client{};
  socklen_t size = sizeof client;
  std::array<pollfd, 2> watched{{{client_side_, POLLIN, 0}, {server_side_, POLLIN, 0}}};
  while (!stopping_) {
    ::poll(watched.data(), watched.size(), 1);
    for (const bool to_server : {true, false}) {
      std::vector<std::byte> bytes(2048);
      sockaddr_in sender{};
      const ssize_t got = ::recvfrom(to_server ? client_side_ : server_side_, bytes.data(), bytes.size(), MSG_DONTWAIT,
                                     reinterpret_cast<sockaddr*>(&sender), &size);
      if (got < 0) continue;
      if (to_server) client = sender;
      bytes.resize(static_cast<std::size_t>(got));
      if (hooks.passing) hooks.passing(to_server, bytes);
      const double fate = share();
      const int copies = fate < network.lost ? 0 : fate < network.lost + network.doubled ? 2 : 1;
      for (int i = 0; i < copies; ++i) {
        const double late = share() < network.delayed ? share() : 0;
        const auto extra = std::chrono::duration_cast<Clock::duration>(network.delay * late);
        held.push_back({to_server, bytes, Clock::now() + network.latency + extra});
      }
    }
    const auto now = Clock::now();
    if (is_cut_) held.clear();
    std::erase_if(held, [&](const Held& datagram) {
      if (datagram.due > now) return false;
      if (datagram.to_server) {
        ::send(server_side_, datagram.bytes.data(), datagram.bytes.size(), 0);
      } else {
        ::sendto(client_side_, datagram.bytes.data(), datagram.bytes.size(), 0, reinterpret_cast<sockaddr*>(&client),
                 size);
      }
      return true;
    });
  }
}

}  // namespace kenaf::support
