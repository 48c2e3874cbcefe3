// CANopen's heartbeat: which nodes are there, and in what state. CiA 301, sections 7.2.8.3 (heartbeat and boot-up
// protocol) and 7.3.2 (NMT states).
#pragma once

#include <linux/can.h>

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace kenaf::real {

inline constexpr canid_t kHeartbeatId = 0x700;  // + node id

enum class NmtState : std::uint8_t { boot_up = 0x00, stopped = 0x04, operational = 0x05, pre_operational = 0x7f };
std::string_view describe(NmtState state);

struct Heartbeat {
  std::uint8_t node;
  NmtState state;
};

// The heartbeat in a frame; nullopt where it is none: another identifier, not one byte, a state that CiA 301 lacks.
std::optional<Heartbeat> heartbeat_from(const can_frame& frame);

// What a controller's error frame says, in words: "bus off", "no acknowledgement: is anybody else on the bus?".
std::string describe_error_frame(const can_frame& frame);

struct NodesHeard {
  std::map<std::uint8_t, NmtState> state;  // of those that were heard, newest
  std::string bus_error;                   // the newest error frame in words, or ""
};

// Reads frames from `descriptor` (non-blocking) until every one of `nodes` was heard or `patience` is over, wall clock.
// Also ends when `interrupt` becomes readable.
NodesHeard listen_for(std::span<const std::uint8_t> nodes, int descriptor, int interrupt,
                      std::chrono::milliseconds patience);

}  // namespace kenaf::real
