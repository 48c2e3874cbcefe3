// A CAN bus through SocketCAN: CAN_RAW for frames, with filters, error frames and the kernel's time stamps, and CAN_BCM
// for the SYNC, which the kernel sends by its own timer. Source: Documentation/networking/can.rst of the Linux kernel.
//
// Thread safety: as canopen::Bus.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "can/canbus/suspend_watch.hpp"
#include "can/canbus/wall_clock.hpp"
#include "can/canopen/bus.hpp"

namespace kenaf::canbus {

// The bus is not available at all: no SocketCAN in the kernel, no such interface, not a CAN interface, or down. The
// text says what to do.
class NoBus : public canopen::BusError {
 public:
  using canopen::BusError::BusError;
};

class SocketBus final : public canopen::Bus {
 public:
  // Receives standard data frames with one of the identifiers `ids` (at most 512; none: all, remote frames too), and
  // the controller's error frames. Throws NoBus.
  explicit SocketBus(const std::string& interface, std::span<const std::uint16_t> ids = {});
  ~SocketBus() override;
  SocketBus(const SocketBus&) = delete;
  SocketBus& operator=(const SocketBus&) = delete;

  canopen::Time now() const override;
  canopen::Time suspended() override;
  // Waits for room if the interface's queue is full, 20 ms at most.
  void send(const canopen::Frame& frame) override;
  std::optional<canopen::ReceivedFrame> receive(canopen::Time until) override;
  void start_sync(canopen::Time period) override;
  void stop_sync() override;
  void interrupt() override;

 private:
  void open(std::span<const std::uint16_t> ids);
  void close();
  [[noreturn]] void lost(int error) const;
  std::optional<canopen::ReceivedFrame> read_frame();

  std::string interface_;
  int raw_ = -1, broadcast_manager_ = -1, interrupt_ = -1;
  WallClock wall_clock_;
  SuspendWatch suspend_watch_;
  std::string last_warning_;  // the newest error frame in words, "" after none: "no acknowledgement: is anybody else on
                              // the bus?"
};

// Describes a controller's error frame. <linux/can/error.h>
std::string describe_error_frame(std::uint32_t can_id);

}  // namespace kenaf::canbus
