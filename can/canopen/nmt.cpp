#include "can/canopen/nmt.hpp"

#include <array>

namespace kenaf::canopen {
namespace {

constexpr std::uint8_t kGuardToggle = 0x80;

bool is_state(std::uint8_t value) {
  switch (static_cast<NmtState>(value)) {
    case NmtState::boot_up:
    case NmtState::stopped:
    case NmtState::operational:
    case NmtState::pre_operational:
      return true;
  }
  return false;
}

bool is_command(std::uint8_t value) {
  switch (static_cast<NmtCommand>(value)) {
    case NmtCommand::start:
    case NmtCommand::stop:
    case NmtCommand::enter_pre_operational:
    case NmtCommand::reset_node:
    case NmtCommand::reset_communication:
      return true;
  }
  return false;
}

}  // namespace

std::string_view describe(NmtState state) {
  switch (state) {
    case NmtState::boot_up:
      return "boot-up";
    case NmtState::stopped:
      return "stopped";
    case NmtState::operational:
      return "operational";
    case NmtState::pre_operational:
      return "pre-operational";
  }
  return "unknown state";
}

Frame encode(const NmtOrder& order) {
  const std::array data{static_cast<std::uint8_t>(order.command), order.node};
  return make_frame(kNmtCommandId, data);
}

std::optional<NmtOrder> nmt_order_from(const Frame& frame) {
  if (frame.id != kNmtCommandId || frame.length != 2 || !is_command(frame.data[0]) || frame.data[1] > kMaxNode)
    return std::nullopt;
  return NmtOrder{static_cast<NmtCommand>(frame.data[0]), frame.data[1]};
}

Frame encode(const Heartbeat& heartbeat) {
  const std::array data{static_cast<std::uint8_t>(heartbeat.state)};
  return make_frame(static_cast<std::uint16_t>(kHeartbeatId + heartbeat.node), data);
}

std::optional<Heartbeat> heartbeat_from(const Frame& frame) {
  const bool of_node = frame.id > kHeartbeatId && frame.id <= kHeartbeatId + kMaxNode;
  if (frame.remote || !of_node || frame.length != 1 || !is_state(frame.data[0])) return std::nullopt;
  return Heartbeat{static_cast<NodeId>(frame.id - kHeartbeatId), static_cast<NmtState>(frame.data[0])};
}

std::optional<ErrorControl> error_control_from(const Frame& frame) {
  Frame without_toggle = frame;
  without_toggle.data[0] &= static_cast<std::uint8_t>(~kGuardToggle);
  const auto heartbeat = heartbeat_from(without_toggle);
  const bool toggle = (frame.data[0] & kGuardToggle) != 0;
  if (!heartbeat || (toggle && heartbeat->state == NmtState::boot_up)) return std::nullopt;
  return ErrorControl{heartbeat->node, heartbeat->state, toggle};
}

Frame guard_request(NodeId node) {
  return {.id = static_cast<std::uint16_t>(kHeartbeatId + node), .length = 1, .remote = true};
}

std::optional<NodeId> guard_request_from(const Frame& frame) {
  if (!frame.remote || frame.id <= kHeartbeatId || frame.id > kHeartbeatId + kMaxNode) return std::nullopt;
  return static_cast<NodeId>(frame.id - kHeartbeatId);
}

Frame encode(const ErrorControl& answer) {
  Frame frame = encode(Heartbeat{answer.node, answer.state});
  if (answer.toggle) frame.data[0] |= kGuardToggle;
  return frame;
}

bool is_sync(const Frame& frame) {
  return frame.id == kSyncId && frame.length <= 1;
}

}  // namespace kenaf::canopen
