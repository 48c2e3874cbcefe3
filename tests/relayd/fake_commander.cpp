#include "tests/relayd/fake_commander.hpp"

#include <poll.h>
#include <sys/socket.h>

#include <array>
#include <chrono>
#include <stdexcept>

#include "tests/support/loopback.hpp"

namespace kenaf::test {

namespace {

using Clock = std::chrono::steady_clock;
constexpr auto kPatience = std::chrono::seconds(10);
constexpr int kResend_ms = 4;

}  // namespace

FakeCommander::FakeCommander(std::uint16_t relay_port, std::uint64_t session)
    : fd_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)), session_(session) {
  const sockaddr_in address = loopback(relay_port);
  if (::connect(fd_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    throw std::runtime_error("connect");
  }
}

void FakeCommander::send(const relay::Datagram& datagram) {
  std::array<std::byte, relay::kMaxDatagramBytes> bytes;
  send_bytes({bytes.data(), relay::encode(datagram, bytes)});
}

void FakeCommander::send_bytes(std::span<const std::byte> bytes) {
  ::send(fd_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
}

std::optional<relay::Datagram> FakeCommander::receive(int milliseconds) {
  pollfd reading{fd_.get(), POLLIN, 0};
  std::array<std::byte, relay::kMaxDatagramBytes> bytes;
  if (::poll(&reading, 1, milliseconds) <= 0) return std::nullopt;
  const ssize_t got = ::recv(fd_.get(), bytes.data(), bytes.size(), 0);
  relay::Datagram datagram;
  if (got < 0 || relay::decode({bytes.data(), static_cast<std::size_t>(got)}, datagram) != relay::DecodeError::none) {
    return std::nullopt;
  }
  return datagram;
}

relay::Datagram FakeCommander::hello(bool lockstep, bool reset_robot, double period_s, double timeout_s) {
  const auto end = Clock::now() + kPatience;
  while (Clock::now() < end) {
    send(relay::Hello{session_, period_s, timeout_s, lockstep, reset_robot});
    const auto answer = receive(20);
    if (!answer) continue;
    if (std::holds_alternative<relay::Welcome>(*answer) || std::holds_alternative<relay::Refused>(*answer)) {
      return *answer;
    }
  }
  throw std::runtime_error("the relay does not answer Hello");
}

std::optional<relay::State> FakeCommander::next_state(std::uint32_t after, const relay::Datagram& again) {
  const auto end = Clock::now() + kPatience;
  while (Clock::now() < end) {
    const auto datagram = receive(kResend_ms);
    if (!datagram) send(again);
    const auto* state = datagram ? std::get_if<relay::State>(&*datagram) : nullptr;
    if (state != nullptr && state->session == session_ && state->robot.frame > after) return *state;
  }
  return std::nullopt;
}

std::optional<relay::State> FakeCommander::wait_for(const std::function<bool(const relay::State&)>& holds) {
  const auto end = Clock::now() + kPatience;
  while (Clock::now() < end) {
    const auto datagram = receive(50);
    const auto* state = datagram ? std::get_if<relay::State>(&*datagram) : nullptr;
    if (state != nullptr && state->session == session_ && holds(*state)) return *state;
  }
  return std::nullopt;
}

std::vector<relay::State> FakeCommander::drive(
    std::uint32_t frames, const std::function<void(const relay::State&, relay::Command&)>& control) {
  std::vector<relay::State> states;
  relay::Datagram again = relay::Ping{session_, 0};
  std::uint32_t after = 0;
  for (std::uint32_t i = 1; i <= frames; ++i) {
    const auto state = next_state(after, again);
    if (!state) throw std::runtime_error("no State any more");
    after = state->robot.frame;
    states.push_back(*state);
    relay::Command next = command(i, state->robot.frame, 0, 0);
    control(*state, next);
    again = next;
    send(again);
  }
  // The last command has arrived once a State says so.
  next_state(after, again);
  return states;
}

relay::Command FakeCommander::command(std::uint32_t sequence, std::uint32_t frame, double left_mps,
                                      double right_mps) const {
  return {session_, sequence, frame, {left_mps, right_mps}, 0, {}};
}

std::string text_of(const relay::Refused& refused) {
  return {refused.text.data(), refused.text_length};
}

}  // namespace kenaf::test
