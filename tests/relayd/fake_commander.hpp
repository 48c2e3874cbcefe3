// A program at the relay's UDP side, keeping docs/relay-protocol.md: what is not answered is sent again.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "formats/protocol/relay_datagram.hpp"
#include "relayd/sockets.hpp"

namespace kenaf::test {

class FakeCommander {
 public:
  FakeCommander(std::uint16_t relay_port, std::uint64_t session);
  // To another address of this machine.
  FakeCommander(const relayd::Address& relay, std::uint64_t session);

  void send(const protocol::relay::Datagram& datagram);
  void send_bytes(std::span<const std::byte> bytes);
  // The next datagram, or nullopt after `milliseconds`.
  std::optional<protocol::relay::Datagram> receive(int milliseconds);

  // Says Hello until it is answered.
  protocol::relay::Datagram hello(bool lockstep, bool reset_robot = false, double period_s = 0.01,
                                  double timeout_s = 0.5);
  // The next State with a frame beyond that of `after`, sending `again` every few milliseconds meanwhile; nullopt
  // after 10 s.
  std::optional<protocol::relay::State> next_state(std::uint32_t after, const protocol::relay::Datagram& again);
  // Waits, silently, for a State that holds; nullopt after 10 s.
  std::optional<protocol::relay::State> wait_for(const std::function<bool(const protocol::relay::State&)>& holds);
  // `frames` steps in lock step: a command for each State, by the State alone. All States but the last.
  std::vector<protocol::relay::State> drive(
      std::uint32_t frames,
      const std::function<void(const protocol::relay::State&, protocol::relay::Command&)>& control);
  protocol::relay::Command command(std::uint32_t sequence, std::uint32_t frame, double left_mps,
                                   double right_mps) const;

 private:
  relayd::Descriptor fd_;
  std::uint64_t session_;
};

std::string text_of(const protocol::relay::Refused& refused);

}  // namespace kenaf::test
