// Quirks of one type of drive, as its device file says (`devices/NAME.toml`, named by `device` in [can]). Each key's
// default is what the standards say, CiA 301 and CiA 402: a drive without a device file behaves so. docs/can-robot.md
// has the keys as a table, share/devices/standard.toml all of them with their defaults.
//
// Thread safety: values and pure functions, except load_device, which reads the environment and files.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace kenaf::canbus {

enum class ErrorControl : std::uint8_t {
  heartbeat,      // objects 0x1016, 0x1017
  node_guarding,  // objects 0x100C, 0x100D: the master asks by remote frames, and the drive misses them
};
enum class Mapping : std::uint8_t {
  written,  // the master writes which objects are in a PDO
  cia402,   // fixed: the default mapping of CiA 402-2. RPDO3 or 4, TPDO3 and 4; no current
};
enum class ModeChange : std::uint8_t {
  enabled,   // in any state
  disabled,  // only while the drive is not enabled: before a motion, and by a pause without torque after homing
};
enum class VelocitySign : std::uint8_t {
  two_complement,  // 0x606C as CiA 402 has it, INTEGER32
  low_16_bits,     // a number of 16 bits whose sign is not extended to 32
  magnitude,       // without sign: it is that of the position's change
};

struct Device {
  std::string name;  // as [can] names it; "": none is named

  double boot_s = 0;  // from a reset to its boot-up message; 0: not known, short
  ErrorControl error_control = ErrorControl::heartbeat;

  Mapping mapping = Mapping::written;
  bool mapping_count_first = false;  // a mapping's count is written to 0 before its PDO is switched off, not after it
  int command_pdo = 1;               // number of the RPDO for controlword and target; with Mapping::written
  int command_every = 1;             // cycles from one command to the next; the first of urgent stops does not wait

  ModeChange mode_change = ModeChange::enabled;
  bool halt_blocks_mode = false;    // the mode is not written before commands without halt bit arrive
  bool zero_target_by_sdo = false;  // target velocities in PDOs have no effect before the drive is enabled
  int fault_reset_cycles = 1;       // how long bit 7 of the controlword is high, and then low

  VelocitySign velocity = VelocitySign::two_complement;
  int position_bits = 32;         // 0x6064 counts modulo 2 to this power
  bool currents = true;           // has 0x6075 and 0x6078
  bool battery = true;            // has 0x6079
  int home_offset_direction = 1;  // +1: at home the position is object 0x607C; -1: minus that
};

// Takes a shipped name ("standard") or the path of a TOML file. Throws DescriptionError with file, line and column: a
// key that is unknown or out of range, or that contradicts another.
Device load_device(const std::string& name_or_path);
// `name` becomes the device's.
Device parse_device(std::string_view toml_text, const std::string& name, const std::string& name_for_errors);

// Says where a key of a device file belongs, for the end of an error: "; `boot_s = 12` in its device file (elmo)".
std::string advice(const Device& device, std::string_view setting);

}  // namespace kenaf::canbus
