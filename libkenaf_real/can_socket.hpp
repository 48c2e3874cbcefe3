// A CAN_RAW socket on one interface. Every way in which it cannot be had is told apart, with what to do about it.
#pragma once

#include <linux/can.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace kenaf::real {

class CanSocket {
 public:
  // Receives the heartbeats of `nodes` and the controller's error frames; nothing is sent. Throws
  // hrt::Error(HRT_E_DEVICE): no SocketCAN in the kernel, no such interface, not a CAN interface, interface down.
  CanSocket(const std::string& interface, std::span<const std::uint8_t> nodes);
  ~CanSocket();
  CanSocket(const CanSocket&) = delete;
  CanSocket& operator=(const CanSocket&) = delete;

  int descriptor() const { return socket_; }

 private:
  int socket_ = -1;
};

// The receive filters that let through exactly the heartbeats of `nodes`.
std::vector<can_filter> heartbeat_filters(std::span<const std::uint8_t> nodes);

}  // namespace kenaf::real
