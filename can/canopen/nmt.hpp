// Network management: sender of a frame, states, commands, heartbeat, SYNC. CiA 301, 7.2.5 (SYNC), 7.2.8 (NMT) and
// 7.3.3 (predefined connection set). Thread safety: values and pure functions.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "can/canopen/frame.hpp"

namespace kenaf::canopen {

using NodeId = std::uint8_t;  // 1 to 127
inline constexpr NodeId kMaxNode = 127;

// COB-IDs of the predefined connection set; for services of a node, plus its id.
inline constexpr std::uint16_t kNmtCommandId = 0x000, kSyncId = 0x080, kEmergencyId = 0x080;
inline constexpr std::uint16_t kTransmitPdoId[4] = {0x180, 0x280, 0x380, 0x480};
inline constexpr std::uint16_t kReceivePdoId[4] = {0x200, 0x300, 0x400, 0x500};
inline constexpr std::uint16_t kSdoResponseId = 0x580, kSdoRequestId = 0x600, kHeartbeatId = 0x700;

enum class NmtState : std::uint8_t { boot_up = 0x00, stopped = 0x04, operational = 0x05, pre_operational = 0x7f };
std::string_view describe(NmtState state);  // "pre-operational"

enum class NmtCommand : std::uint8_t {
  start = 0x01,
  stop = 0x02,
  enter_pre_operational = 0x80,
  reset_node = 0x81,
  reset_communication = 0x82,
};

struct NmtOrder {
  NmtCommand command;
  NodeId node;  // 0: all nodes
};

Frame encode(const NmtOrder& order);
// nullopt: another identifier, not two bytes, a command not in CiA 301, or a node above 127.
std::optional<NmtOrder> nmt_order_from(const Frame& frame);

struct Heartbeat {
  NodeId node;
  NmtState state;  // boot_up: the node has just started
};

Frame encode(const Heartbeat& heartbeat);
// nullopt: another identifier, not one byte, or a state not in CiA 301 (bit 7 is node guarding's toggle bit, 0 here).
std::optional<Heartbeat> heartbeat_from(const Frame& frame);

// A heartbeat, or an answer of node guarding (7.2.8.3.2.1): the same byte, in which the latter's toggle bit is bit 7.
struct ErrorControl {
  NodeId node;
  NmtState state;
  bool toggle;  // false for a heartbeat and for boot-up
};
// nullopt: another identifier, not one byte, or a state not in CiA 301.
std::optional<ErrorControl> error_control_from(const Frame& frame);

// Node guarding, 7.2.8.3.2.1: the master's request, which the node answers by its ErrorControl.
Frame guard_request(NodeId node);
// The node that is asked; nullopt for any other frame.
std::optional<NodeId> guard_request_from(const Frame& frame);
Frame encode(const ErrorControl& answer);

// A SYNC without counter, as of a SYNC producer whose object 0x1019 is 0.
inline constexpr Frame kSync{.id = kSyncId};
// A SYNC with a counter byte counts too.
bool is_sync(const Frame& frame);

}  // namespace kenaf::canopen
