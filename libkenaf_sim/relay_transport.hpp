// The simulated robot: UDP datagrams to kenaf-relayd and back. docs/relay-protocol.md has the protocol.
//
// A Command is resent until the State of the next frame arrives, so that loss costs only milliseconds; a State that is
// not newer than all before is a duplicate or late, and is ignored.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <optional>
#include <string>

#include "formats/protocol/relay_datagram.hpp"
#include "hrt/transport.hpp"
#include "libkenaf_sim/addresses.hpp"

namespace kenaf::sim {

class RelayTransport final : public hrt::Transport {
 public:
  explicit RelayTransport(AskForAddresses ask = ask_system);
  ~RelayTransport() override;
  RelayTransport(const RelayTransport&) = delete;
  RelayTransport& operator=(const RelayTransport&) = delete;

  hrt::Connection open(const hrt_config& config) override;
  std::optional<robot::State> wait_state() override;
  void send(const robot::Command& command) override;
  void keep_alive() override;
  void interrupt() override;
  void close() override;
  const std::string& warning() const override;
  double round_trip_s() const override { return round_trip_s_; }
  bool is_paused() const override { return is_paused_; }

 private:
  using Clock = std::chrono::steady_clock;

  void connect_to(std::size_t address);  // of those of the relay's name
  void connect_to_next();
  hrt::Connection greet(const protocol::relay::Hello& hello, Clock::time_point deadline);
  // Returns the next well-formed datagram waiting in the socket.
  std::optional<protocol::relay::Datagram> receive();
  // Returns a state that begins a new cycle. Throws if the datagram ends the session.
  std::optional<robot::State> take(const protocol::relay::Datagram& datagram);
  void transmit(const protocol::relay::Datagram& datagram);
  void send_what_is_due(Clock::time_point now);
  void ping(Clock::time_point now);
  void check_life(Clock::time_point now);  // the first State has connect_timeout_s, counted from open()
  // Sleeps until a datagram, an interrupt or `until`. Returns false if interrupted.
  bool wait_readable(Clock::time_point until);

  std::string relay_;
  AskForAddresses ask_;
  Addresses addresses_;
  std::size_t address_ = 0;  // which of them the socket is connected to
  double link_timeout_s_ = 0, connect_timeout_s_ = 0;
  int socket_ = -1, interrupt_ = -1;
  bool not_at_start_ = false;  // as of the newest State
  bool port_closed_ = false;   // the last send or receive reported that nobody listens there
  std::array<std::byte, protocol::relay::kMaxDatagramBytes + 1> buffer_{};

  std::uint64_t session_ = 0;           // 0: none
  std::uint32_t frame_ = 0;             // newest State
  protocol::relay::Command command_{};  // sequence 0: none yet
  Clock::time_point resend_at_, state_at_, life_at_, alive_at_, ping_at_, pinged_at_;
  Clock::time_point looked_at_;  // when the socket was last looked at
  Clock::duration resend_after_{};
  std::uint32_t ping_id_ = 0;
  std::atomic<double> round_trip_s_ = 0;
  std::atomic<bool> is_paused_ = false;
};

}  // namespace kenaf::sim
