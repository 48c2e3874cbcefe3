// What can go wrong with a node or the bus, on demand.
#pragma once

#include <cstdint>

#include "can/canopen/emergency.hpp"
#include "can/canopen/frame.hpp"

namespace kenaf::candrives {

enum class FaultKind : std::uint8_t {
  silent,            // its cable is cut: it neither sends nor hears anything
  power_loss,        // off at once, and anew kPowerGap later, with all its objects as at first
  error,             // a drive's own: fault reaction, fault, emergency message with error_code
  following_error,   // the same with 0x8611 and its bit in the statusword
  deaf,              // a drive hears controlwords and does not act on them
  sdo_abort,         // each SDO request is answered by an abort
  sdo_late,          // each SDO answer comes kLateBy later
  sdo_wrong_toggle,  // each segment's answer has the wrong toggle bit
  short_pdos,        // its PDOs lack their last byte
  garbage,           // the whole bus: random frames, one each millisecond
  healed,            // none of these any more
};

inline constexpr canopen::Time kPowerGap = std::chrono::milliseconds(500), kLateBy = std::chrono::seconds(1);

struct Fault {
  FaultKind kind;
  canopen::NodeId node;          // 0: all nodes; without meaning for garbage
  std::uint16_t error_code = 0;  // of error
};

// What stands between a node and the bus while some of these are at work.
struct NodeFaults {
  bool silent = false, sdo_abort = false, sdo_late = false, sdo_wrong_toggle = false, short_pdos = false;
};
// The node's frame as it goes onto the bus.
canopen::Frame altered(const canopen::Frame& frame, canopen::NodeId node, const NodeFaults& faults);
bool is_sdo_answer(const canopen::Frame& frame, canopen::NodeId node);

}  // namespace kenaf::candrives
