// Faults of a node or the bus, injected on demand.
#pragma once

#include <cstdint>

#include "can/canopen/emergency.hpp"
#include "can/canopen/frame.hpp"

namespace kenaf::candrives {

enum class FaultKind : std::uint8_t {
  silent,            // its cable is cut: it neither sends nor receives
  power_loss,        // off at once, on again kPowerGap later, with all objects at their initial values
  error,             // internal error of a drive: fault reaction, fault, emergency message with error_code
  following_error,   // the same with 0x8611 and its statusword bit
  deaf,              // a drive receives controlwords and ignores them
  no_heartbeat,      // it does not notice that the master's heartbeat ends
  no_event_timer,    // it does not notice that its RPDOs stay away
  sdo_abort,         // each SDO request is answered by an abort
  sdo_late,          // each SDO answer is delayed by kLateBy
  sdo_wrong_toggle,  // each segment's answer has the wrong toggle bit
  short_pdos,        // its PDOs lack their last byte
  garbage,           // whole bus: one random frame each millisecond
  sdo_garbage,       // SDO answers have random bytes where they have no data
  // What drives of some types always do: quirks.hpp.
  slow_boot,
  guarding_only,
  count_first,
  fixed_mapping,
  first_rpdo_fixed,
  slow_commands,
  mode_locked,
  halt_blocks_mode,
  old_target,
  slow_fault_reset,
  velocity_unsigned,
  velocity_16_bits,
  position_16_bits,
  position_24_bits,
  no_current,
  no_voltage,
  home_offset_negative,
  missing_commands_fault,
  healed,  // ends all of these
};

inline constexpr canopen::Time kPowerGap = std::chrono::milliseconds(500), kLateBy = std::chrono::seconds(1);

struct Fault {
  FaultKind kind;
  canopen::NodeId node;          // 0: all nodes; ignored for garbage
  std::uint16_t error_code = 0;  // for kind error
};

// Faults between a node and the bus.
struct NodeFaults {
  bool silent = false, sdo_abort = false, sdo_late = false, sdo_wrong_toggle = false, short_pdos = false,
       sdo_garbage = false;
};
// Returns the node's frame as it appears on the bus.
canopen::Frame altered(const canopen::Frame& frame, canopen::NodeId node, const NodeFaults& faults);
bool is_sdo_answer(const canopen::Frame& frame, canopen::NodeId node);

}  // namespace kenaf::candrives
