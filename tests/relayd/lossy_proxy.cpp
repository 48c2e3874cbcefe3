#include "tests/relayd/lossy_proxy.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <random>
#include <vector>

#include "tests/relayd/allocations.hpp"

namespace kenaf::test {

namespace {

using Clock = std::chrono::steady_clock;

struct Held {
  bool to_relay;
  std::vector<char> bytes;
  Clock::time_point due;
};

}  // namespace

LossyProxy::LossyProxy(std::uint16_t relay_port, unsigned seed)
    : relay_side_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
  relayd::Address bound;
  program_side_ = relayd::open_udp({0x7f000001, 0}, bound);
  port_ = bound.port;
  sockaddr_in relay{};
  relay.sin_family = AF_INET;
  relay.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  relay.sin_port = htons(relay_port);
  ::connect(relay_side_.get(), reinterpret_cast<sockaddr*>(&relay), sizeof relay);
  thread_ = std::thread(&LossyProxy::run, this, seed);
}

LossyProxy::~LossyProxy() {
  stopping_ = true;
  thread_.join();
}

void LossyProxy::run(unsigned seed) {
  leave_this_thread_out();
  std::mt19937 random(seed);
  std::vector<Held> held;
  sockaddr_in program{};
  socklen_t size = sizeof program;
  std::array<pollfd, 2> watched{{{program_side_.get(), POLLIN, 0}, {relay_side_.get(), POLLIN, 0}}};
  while (!stopping_) {
    ::poll(watched.data(), watched.size(), 1);
    for (const bool to_relay : {true, false}) {
      std::vector<char> bytes(1024);
      const int from = to_relay ? program_side_.get() : relay_side_.get();
      sockaddr_in sender{};
      const ssize_t got =
          ::recvfrom(from, bytes.data(), bytes.size(), MSG_DONTWAIT, reinterpret_cast<sockaddr*>(&sender), &size);
      if (got < 0) continue;
      if (to_relay) program = sender;
      bytes.resize(static_cast<std::size_t>(got));
      const auto fate = random() % 10;
      const unsigned copies = fate < 2 ? 0 : fate < 4 ? 2 : 1;
      for (unsigned i = 0; i < copies; ++i) {
        const auto delay = std::chrono::microseconds(random() % 4 == 0 ? random() % 8000 : 0);
        held.push_back({to_relay, bytes, Clock::now() + delay});
      }
    }
    const auto now = Clock::now();
    std::erase_if(held, [&](const Held& datagram) {
      if (datagram.due > now) return false;
      if (datagram.to_relay) {
        ::send(relay_side_.get(), datagram.bytes.data(), datagram.bytes.size(), 0);
      } else {
        ::sendto(program_side_.get(), datagram.bytes.data(), datagram.bytes.size(), 0,
                 reinterpret_cast<sockaddr*>(&program), size);
      }
      return true;
    });
  }
}

}  // namespace kenaf::test
