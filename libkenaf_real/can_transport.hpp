// The real robot: CiA 402 drives on a CAN bus. Runs beat by beat in the one thread that waits for states and answers
// them.
//
// Loss of control stops the robot: a program that ends or hangs no longer sends a heartbeat, and the drives stop by
// themselves after master_silence_s; a drive that is silent, in fault or restarted ends the loop with a quick stop of
// all others; so does a bus that is down or off.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "can/canopen/bus.hpp"
#include "hrt/transport.hpp"
#include "robot/state.hpp"

namespace kenaf::real {

// Opens the bus that configuration and description name; throws canopen::BusError.
using OpenBus =
    std::function<std::unique_ptr<canopen::Bus>(const std::string& interface, std::span<const std::uint16_t> ids)>;

class CanTransport final : public hrt::Transport {
 public:
  explicit CanTransport(OpenBus open_bus);
  ~CanTransport() override;
  CanTransport(const CanTransport&) = delete;
  CanTransport& operator=(const CanTransport&) = delete;

  hrt::Connection open(const hrt_config& config) override;
  void prepare_cycles(std::thread::native_handle_type thread) override;
  void begin_cycles() override;
  std::optional<robot::State> wait_state() override;
  void send(const robot::Command& command) override;
  void interrupt() override;
  void close() override;
  const std::string& warning() const override;
  std::string setup() const override;
  double round_trip_s() const override;
  bool is_paused() const override { return false; }

 private:
  struct Session;  // an open robot
  hrt::Connection set_up(const hrt_config& config);
  std::optional<robot::State> measure();  // as wait_state, with beats and late orders counted since SYNC began
  template <typename Step>
  auto in_the_loop(Step step);

  OpenBus open_bus_;
  std::unique_ptr<Session> session_;
};

}  // namespace kenaf::real
