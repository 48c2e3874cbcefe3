// The real robot: its CAN bus. In this release open() looks for the drives and then ends with HRT_E_DEVICE, because
// they are not driven yet; so nothing that follows open() is ever reached with an open bus.
#pragma once

#include <memory>

#include "hrt/transport.hpp"
#include "libkenaf_real/can_socket.hpp"

namespace kenaf::real {

class CanTransport final : public hrt::Transport {
 public:
  CanTransport();
  ~CanTransport() override;
  CanTransport(const CanTransport&) = delete;
  CanTransport& operator=(const CanTransport&) = delete;

  hrt::Connection open(const hrt_config& config) override;
  std::optional<relay::State> wait_state() override;
  void send(const hrt::DriveCommand& command) override;
  void interrupt() override;
  void close() override;
  double round_trip_s() const override { return 0; }
  bool is_paused() const override { return false; }

 private:
  std::unique_ptr<CanSocket> socket_;
  int interrupt_;
};

}  // namespace kenaf::real
