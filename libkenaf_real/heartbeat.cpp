#include "libkenaf_real/heartbeat.hpp"

#include <linux/can/error.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>

namespace kenaf::real {

std::string_view describe(NmtState state) {
  switch (state) {
    case NmtState::boot_up:
      return "booting";
    case NmtState::stopped:
      return "stopped";
    case NmtState::operational:
      return "operational";
    case NmtState::pre_operational:
      return "pre-operational";
  }
  return "unknown";
}

std::optional<Heartbeat> heartbeat_from(const can_frame& frame) {
  const bool plain = (frame.can_id & (CAN_EFF_FLAG | CAN_RTR_FLAG | CAN_ERR_FLAG)) == 0;
  const canid_t id = frame.can_id & CAN_SFF_MASK;
  if (!plain || id <= kHeartbeatId || id > kHeartbeatId + 127 || frame.can_dlc != 1) return std::nullopt;
  const auto node = static_cast<std::uint8_t>(id - kHeartbeatId);
  // Bit 7 was the toggle bit of node guarding, the heartbeat's predecessor; a heartbeat has it 0.
  switch (frame.data[0]) {
    case 0x00:
      return Heartbeat{node, NmtState::boot_up};
    case 0x04:
      return Heartbeat{node, NmtState::stopped};
    case 0x05:
      return Heartbeat{node, NmtState::operational};
    case 0x7f:
      return Heartbeat{node, NmtState::pre_operational};
    default:
      return std::nullopt;
  }
}

std::string describe_error_frame(const can_frame& frame) {
  if ((frame.can_id & CAN_ERR_BUSOFF) != 0) return "bus off: too many errors; is the bit rate right?";
  if ((frame.can_id & CAN_ERR_ACK) != 0) return "no acknowledgement: is anybody else on the bus?";
  if ((frame.can_id & CAN_ERR_TRX) != 0) return "transceiver error: is the cable whole?";
  if ((frame.can_id & CAN_ERR_CRTL) != 0) return "controller error: errors on the bus or too many frames";
  if ((frame.can_id & CAN_ERR_TX_TIMEOUT) != 0) return "sending timed out";
  if ((frame.can_id & CAN_ERR_BUSERROR) != 0) return "bus error: is the bus terminated, and the bit rate right?";
  if ((frame.can_id & CAN_ERR_RESTARTED) != 0) return "controller restarted";
  return "unknown error";
}

NodesHeard listen_for(std::span<const std::uint8_t> nodes, int descriptor, int interrupt,
                      std::chrono::milliseconds patience) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point deadline = Clock::now() + patience;
  NodesHeard heard;
  const auto all_heard = [&] {
    return std::ranges::all_of(nodes, [&](std::uint8_t n) { return heard.state.contains(n); });
  };
  while (!all_heard()) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now());
    if (left.count() <= 0) break;
    std::array<pollfd, 2> watched{{{descriptor, POLLIN, 0}, {interrupt, POLLIN, 0}}};
    poll(watched.data(), watched.size(), static_cast<int>(left.count()));
    if ((watched[1].revents & POLLIN) != 0) break;
    if ((watched[0].revents & (POLLERR | POLLHUP | POLLNVAL)) != 0 && (watched[0].revents & POLLIN) == 0) {
      heard.bus_error = "the interface went away";
      break;
    }
    can_frame frame{};
    while (!all_heard() && read(descriptor, &frame, sizeof frame) == static_cast<ssize_t>(sizeof frame)) {
      if ((frame.can_id & CAN_ERR_FLAG) != 0) {
        heard.bus_error = describe_error_frame(frame);
      } else if (const std::optional<Heartbeat> heartbeat = heartbeat_from(frame)) {
        heard.state[heartbeat->node] = heartbeat->state;
      }
    }
  }
  return heard;
}

}  // namespace kenaf::real
