// What drives that people use do otherwise than the standards say: each the opposite of a default in
// can/canbus/device_file.hpp. Off by default; a fault switches one on.
#pragma once

#include "can/candrives/fault.hpp"

namespace kenaf::candrives {

inline constexpr canopen::Time kSlowBoot = std::chrono::seconds(10), kSlowReset = std::chrono::milliseconds(30);
inline constexpr int kSyncsOfSlowCommand = 3;

struct Quirks {
  // Of any node.
  bool slow_boot = false;         // boots kSlowBoot after a reset, deaf and silent until then
  bool guarding_only = false;     // has no objects 0x1016 and 0x1017
  bool count_first = false;       // a PDO with mapped objects cannot be switched off
  bool fixed_mapping = false;     // no mapping can be written
  bool first_rpdo_fixed = false;  // that of RPDO1 cannot be written
  bool slow_commands = false;     // a PDO fewer than kSyncsOfSlowCommand after the one before is lost, and a fault

  // Of drives.
  bool mode_locked = false;           // 0x6060 cannot be written while operation is enabled
  bool halt_blocks_mode = false;      // nor while bit 8 of the controlword is set, as it is after power on
  bool old_target = false;            // begins with a target velocity; those in PDOs count only in operation enabled
  bool slow_fault_reset = false;      // bit 7 must be high for kSlowReset
  bool velocity_unsigned = false;     // 0x606C has no sign
  bool velocity_16_bits = false;      // 0x606C has the lower 16 bits only
  int position_bits = 32;             // of 0x6064; above them it is 0
  bool no_current = false;            // has no objects 0x6075 and 0x6078
  bool no_voltage = false;            // has no object 0x6079
  bool home_offset_negative = false;  // at home the position is minus object 0x607C
  // The event timer's end is a fault while the motor has power, after a quick stop, too: its maker's choice (CiA 301).
  bool missing_commands_fault = false;
};

// Switches on what the fault stands for; false: it is none of these.
bool switch_on(Quirks& quirks, FaultKind fault);

}  // namespace kenaf::candrives
