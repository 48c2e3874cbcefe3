// Any frame of a CAN bus is a heartbeat of a node from 1 to 127 or is none; an error frame always has words.
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "libkenaf_real/heartbeat.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  can_frame frame{};
  if (size < sizeof frame) return 0;
  std::memcpy(&frame, data, sizeof frame);
  if (const auto heartbeat = kenaf::real::heartbeat_from(frame)) {
    if (heartbeat->node < 1 || heartbeat->node > 127 ||
        (frame.can_id & CAN_SFF_MASK) != kenaf::real::kHeartbeatId + heartbeat->node)
      __builtin_trap();
    if (kenaf::real::describe(heartbeat->state).empty()) __builtin_trap();
  }
  if (kenaf::real::describe_error_frame(frame).empty()) __builtin_trap();
  return 0;
}
