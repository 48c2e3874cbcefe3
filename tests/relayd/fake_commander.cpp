#include "tests/relayd/fake_commander.hpp"

#include <poll.h>
#include <sys/socket.h>

#include <array>
#include <chrono>
#include <stdexcept>

#include "tests/support/patience.hpp"
#include "tests/support/robot_command.hpp"

namespace kenaf::test {

namespace {

using Clock = std::chrono::steady_clock;
constexpr int kResend_ms = 4;

}  // namespace

FakeCommander::FakeCommander(std::uint16_t relay_port, std::uint64_t session)
    : FakeCommander(relayd::parse_address("127.0.0.1:" + std::to_string(relay_port)), session) {}

FakeCommander::FakeCommander(const relayd::Address& relay, std::uint64_t session) : session_(session) {
  const relayd::Endpoint endpoint = relayd::endpoint_of(relay, relayd::is_ipv4(relay) ? AF_INET : AF_INET6);
  fd_ = relayd::Descriptor(::socket(endpoint.address.ss_family, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  if (::connect(fd_.get(), reinterpret_cast<const sockaddr*>(&endpoint.address), endpoint.size) != 0) {
    throw std::runtime_error("connect");
  }
}

void FakeCommander::send(const protocol::relay::Datagram& datagram) {
  std::array<std::byte, protocol::relay::kMaxDatagramBytes> bytes;
  send_bytes({bytes.data(), protocol::relay::encode(datagram, bytes)});
}

void FakeCommander::send_bytes(std::span<const std::byte> bytes) {
  ::send(fd_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
}

std::optional<protocol::relay::Datagram> FakeCommander::receive(int milliseconds) {
  pollfd reading{fd_.get(), POLLIN, 0};
  std::array<std::byte, protocol::relay::kMaxDatagramBytes> bytes;
  if (::poll(&reading, 1, milliseconds) <= 0) return std::nullopt;
  const ssize_t got = ::recv(fd_.get(), bytes.data(), bytes.size(), 0);
  protocol::relay::Datagram datagram;
  if (got < 0 ||
      protocol::relay::decode({bytes.data(), static_cast<std::size_t>(got)}, datagram) != protocol::DecodeError::none) {
    return std::nullopt;
  }
  return datagram;
}

protocol::relay::Datagram FakeCommander::hello(bool lockstep, bool reset_robot, double period_s, double timeout_s) {
  const auto end = Clock::now() + support::patience();
  while (Clock::now() < end) {
    send(protocol::relay::Hello{session_, period_s, timeout_s, lockstep, reset_robot});
    const auto answer = receive(20);
    if (!answer) continue;
    if (std::holds_alternative<protocol::relay::Welcome>(*answer) ||
        std::holds_alternative<protocol::relay::Refused>(*answer)) {
      return *answer;
    }
  }
  throw std::runtime_error("the relay does not answer Hello");
}

std::optional<protocol::relay::State> FakeCommander::next_state(std::uint32_t after,
                                                                const protocol::relay::Datagram& again) {
  const auto end = Clock::now() + support::patience();
  while (Clock::now() < end) {
    const auto datagram = receive(kResend_ms);
    if (!datagram) send(again);
    const auto* state = datagram ? std::get_if<protocol::relay::State>(&*datagram) : nullptr;
    if (state != nullptr && state->session == session_ && state->robot.frame > after) return *state;
  }
  return std::nullopt;
}

std::optional<protocol::relay::State> FakeCommander::wait_for(
    const std::function<bool(const protocol::relay::State&)>& holds) {
  const auto end = Clock::now() + support::patience();
  while (Clock::now() < end) {
    const auto datagram = receive(50);
    const auto* state = datagram ? std::get_if<protocol::relay::State>(&*datagram) : nullptr;
    if (state != nullptr && state->session == session_ && holds(*state)) return *state;
  }
  return std::nullopt;
}

std::vector<protocol::relay::State> FakeCommander::drive(
    std::uint32_t frames,
    const std::function<void(const protocol::relay::State&, protocol::relay::Command&)>& control) {
  std::vector<protocol::relay::State> states;
  protocol::relay::Datagram again = protocol::relay::Ping{session_, 0};
  std::uint32_t after = 0;
  for (std::uint32_t i = 1; i <= frames; ++i) {
    const auto state = next_state(after, again);
    if (!state) throw std::runtime_error("no State any more");
    after = state->robot.frame;
    states.push_back(*state);
    protocol::relay::Command next = command(i, state->robot.frame, 0, 0);
    control(*state, next);
    again = next;
    send(again);
  }
  // The last command has arrived once a State says so.
  next_state(after, again);
  return states;
}

protocol::relay::Command FakeCommander::command(std::uint32_t sequence, std::uint32_t frame, double left_mps,
                                                double right_mps) const {
  return {session_, sequence, frame, support::command_of({left_mps, right_mps})};
}

std::string text_of(const protocol::relay::Refused& refused) {
  return {refused.text.data(), refused.text_length};
}

}  // namespace kenaf::test
