#include "can/candrives/fault.hpp"

#include <algorithm>

#include "can/canopen/sdo.hpp"

namespace kenaf::candrives {

using canopen::Frame;
using canopen::NodeId;

namespace {

bool is_pdo_of(const Frame& frame, NodeId node) {
  return std::ranges::any_of(canopen::kTransmitPdoId, [&](std::uint16_t first) { return frame.id == first + node; });
}

// True if the frame answers a segment request: its specifier, bits 7 to 5, is 0 for an upload and 1 for a download.
bool answers_segment(const Frame& frame) {
  return frame.data[0] >> 5 <= 1;
}

constexpr std::uint8_t kAbort = 0x80, kToggle = 0x10;

}  // namespace

bool is_sdo_answer(const Frame& frame, NodeId node) {
  return frame.id == canopen::kSdoResponseId + node;
}

Frame altered(const Frame& frame, NodeId node, const NodeFaults& faults) {
  Frame on_bus = frame;
  if (faults.short_pdos && is_pdo_of(frame, node) && frame.length > 0) on_bus.data[--on_bus.length] = 0;
  if (!is_sdo_answer(frame, node)) return on_bus;
  if (faults.sdo_abort) {
    on_bus.data[0] = kAbort;
    canopen::put(on_bus.data, 4, 4, static_cast<std::uint32_t>(canopen::SdoAbort::general));
  } else if (faults.sdo_wrong_toggle && answers_segment(frame)) {
    on_bus.data[0] ^= kToggle;
  }
  return on_bus;
}

}  // namespace kenaf::candrives
