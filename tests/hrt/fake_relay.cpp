#include "tests/hrt/fake_relay.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <map>
#include <stdexcept>

#include "tests/support/loopback.hpp"

namespace kenaf::hrt::test {
namespace {

using Clock = std::chrono::steady_clock;
using kenaf::test::loopback;

// A bound UDP socket on a free port.
int bound_socket(std::uint16_t& port) {
  const int descriptor = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  sockaddr_in address = loopback(0);
  socklen_t size = sizeof address;
  if (descriptor < 0 || bind(descriptor, reinterpret_cast<sockaddr*>(&address), size) < 0 ||
      getsockname(descriptor, reinterpret_cast<sockaddr*>(&address), &size) < 0) {
    throw std::runtime_error("no UDP socket");
  }
  port = ntohs(address.sin_port);
  return descriptor;
}

void signal_stop(int descriptor) {
  const std::uint64_t one = 1;
  if (write(descriptor, &one, sizeof one) < 0) throw std::runtime_error("eventfd");
}

using Bytes = std::vector<std::byte>;

// Sender and contents of the next datagram that waits.
bool receive(int descriptor, Bytes& bytes, sockaddr_in& from) {
  bytes.resize(2048);
  socklen_t size = sizeof from;
  const ssize_t got = recvfrom(descriptor, bytes.data(), bytes.size(), 0, reinterpret_cast<sockaddr*>(&from), &size);
  if (got < 0) return false;
  bytes.resize(static_cast<std::size_t>(got));
  return true;
}

void transmit(int descriptor, const Bytes& bytes, const sockaddr_in& to) {
  (void)sendto(descriptor, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof to);
}

}  // namespace

FakeRelay::FakeRelay(const Behaviour& behaviour) : behaviour_(behaviour), plant_(behaviour.plant) {
  socket_ = bound_socket(port_);
  stop_ = eventfd(0, EFD_CLOEXEC);
  thread_ = std::thread([this] { run(); });
}

FakeRelay::~FakeRelay() {
  signal_stop(stop_);
  thread_.join();
  close(socket_);
  close(stop_);
}

std::string FakeRelay::address() const {
  return fmt::format("127.0.0.1:{}", port_);
}

std::vector<protocol::relay::Command> FakeRelay::commands() const {
  const std::lock_guard lock(mutex_);
  return commands_;
}

std::optional<protocol::relay::Hello> FakeRelay::hello() const {
  const std::lock_guard lock(mutex_);
  return hello_;
}

void FakeRelay::run() {
  for (;;) {
    std::array<pollfd, 2> watched{{{socket_, POLLIN, 0}, {stop_, POLLIN, 0}}};
    poll(watched.data(), watched.size(), -1);
    if (watched[1].revents != 0) return;
    Bytes bytes;
    sockaddr_in from{};
    while (receive(socket_, bytes, from)) {
      protocol::relay::Datagram datagram;
      if (protocol::relay::decode(bytes, datagram) != protocol::DecodeError::none) continue;
      const std::lock_guard lock(mutex_);
      for (const protocol::relay::Datagram& answer : answers_to(datagram)) {
        Bytes out(protocol::relay::kMaxDatagramBytes);
        out.resize(protocol::relay::encode(answer, out));
        transmit(socket_, out, from);
      }
    }
  }
}

protocol::relay::State FakeRelay::state() const {
  return {.session = session_,
          .acknowledged = acknowledged_,
          .world_server_lost = false,
          .world_paused = false,
          .not_at_start = behaviour_.not_at_start,
          .robot = plant_.state};
}

std::vector<protocol::relay::Datagram> FakeRelay::answers_to(const protocol::relay::Datagram& datagram) {
  const auto refused = [&](std::uint64_t session, protocol::relay::RefusedReason reason) {
    protocol::relay::Refused answer{};
    answer.session = session;
    answer.reason = reason;
    answer.text_length = behaviour_.words.copy(answer.text.data(), answer.text.size());
    return answer;
  };
  if (const auto* hello = std::get_if<protocol::relay::Hello>(&datagram)) {
    ++hellos_;
    hello_ = *hello;
    if (behaviour_.refuse && behaviour_.refuse_times-- > 0) return {refused(hello->session, *behaviour_.refuse)};
    session_ = hello->session;
    const protocol::relay::Welcome welcome{session_, plant_.state.robot_time_s, behaviour_.plant.period_s, true};
    if (behaviour_.first_state_lost || behaviour_.no_state) return {welcome};
    return {welcome, state()};
  }
  if (const auto* ping = std::get_if<protocol::relay::Ping>(&datagram)) {
    ++pings_;
    if (behaviour_.silent_from_frame != 0 && plant_.state.frame + 1 >= behaviour_.silent_from_frame) return {};
    return {protocol::relay::Pong{ping->session, ping->id}};
  }
  if (std::get_if<protocol::relay::Bye>(&datagram) != nullptr) {
    ++byes_;
    return {};
  }
  const auto* command = std::get_if<protocol::relay::Command>(&datagram);
  if (command == nullptr || command->session != session_) return {};
  if (command->sequence == acknowledged_) ++repeats_;
  const std::uint32_t next = plant_.state.frame + 1;
  const auto happens_at = [&](std::uint32_t frame) { return frame != 0 && next >= frame; };
  if (happens_at(behaviour_.silent_from_frame) || behaviour_.no_state) return {};
  if (command->frame != plant_.state.frame || happens_at(behaviour_.frozen_from_frame)) return {state()};
  if (happens_at(behaviour_.forgets_at_frame))
    return {refused(session_, protocol::relay::RefusedReason::unknown_session)};
  protocol::relay::State event = state();
  if (happens_at(behaviour_.world_lost_at_frame)) {
    event.world_server_lost = true;
    return {event};
  }
  if (happens_at(behaviour_.pause_at_frame) && behaviour_.pause_states-- > 0) {
    event.world_paused = true;
    return {event};
  }
  commands_.push_back(*command);
  plant_.advance(command->robot);
  acknowledged_ = command->sequence;
  return {state()};
}

BadNetwork::BadNetwork(std::uint16_t relay_port, const Quality& quality) : quality_(quality) {
  front_ = bound_socket(port_);
  std::uint16_t unused = 0;
  back_ = bound_socket(unused);
  const sockaddr_in relay_address = loopback(relay_port);
  if (connect(back_, reinterpret_cast<const sockaddr*>(&relay_address), sizeof relay_address) < 0) {
    throw std::runtime_error("no way to the fake relay");
  }
  stop_ = eventfd(0, EFD_CLOEXEC);
  thread_ = std::thread([this] { run(); });
}

BadNetwork::~BadNetwork() {
  signal_stop(stop_);
  thread_.join();
  for (const int descriptor : {front_, back_, stop_}) close(descriptor);
}

std::string BadNetwork::address() const {
  return fmt::format("127.0.0.1:{}", port_);
}

void BadNetwork::run() {
  struct Parcel {
    bool to_relay;
    Bytes bytes;
  };
  std::mt19937 generator(quality_.seed);
  std::uniform_real_distribution<double> chance(0, 1);
  std::multimap<Clock::time_point, Parcel> waiting;
  sockaddr_in commander{};
  for (;;) {
    int patience_ms = -1;
    if (!waiting.empty()) {
      const auto left = std::chrono::ceil<std::chrono::milliseconds>(waiting.begin()->first - Clock::now());
      patience_ms = static_cast<int>(std::max<std::int64_t>(0, left.count()));
    }
    std::array<pollfd, 3> watched{{{front_, POLLIN, 0}, {back_, POLLIN, 0}, {stop_, POLLIN, 0}}};
    poll(watched.data(), watched.size(), patience_ms);
    if (watched[2].revents != 0) return;
    for (const int descriptor : {front_, back_}) {
      Bytes bytes;
      sockaddr_in from{};
      while (receive(descriptor, bytes, from)) {
        const bool to_relay = descriptor == front_;
        if (to_relay) commander = from;
        if (chance(generator) < quality_.loss) {
          ++dropped_;
          continue;
        }
        const int copies = chance(generator) < quality_.doubling ? 2 : 1;
        for (int i = 0; i < copies; ++i) {
          auto delay = std::chrono::milliseconds(0);
          if (chance(generator) < quality_.delay) {
            delay = std::chrono::milliseconds(
                1 + static_cast<int>(generator() % static_cast<unsigned>(quality_.longest_delay_ms)));
          }
          waiting.emplace(Clock::now() + delay, Parcel{to_relay, bytes});
        }
      }
    }
    while (!waiting.empty() && waiting.begin()->first <= Clock::now()) {
      const Parcel parcel = std::move(waiting.begin()->second);
      waiting.erase(waiting.begin());
      if (parcel.to_relay)
        (void)send(back_, parcel.bytes.data(), parcel.bytes.size(), 0);
      else
        transmit(front_, parcel.bytes, commander);
    }
  }
}

}  // namespace kenaf::hrt::test
