// A drive's power state machine as its master sees it: statusword in, controlword out. CiA 402-2 (IEC 61800-7-201), 10.
//
//   switch-on disabled -- shutdown --> ready to switch on -- switch on --> switched on -- enable --> operation enabled
//            ^                                                                                        | quick stop
//            | fault reset                                                                            v
//          fault  <-- fault reaction active  <---------- (any state, by the drive)           quick stop active
//
// Thread safety: values and pure functions.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "can/canopen/pdo.hpp"

namespace kenaf::canopen {

enum class PowerState : std::uint8_t {
  not_ready,
  switch_on_disabled,
  ready_to_switch_on,
  switched_on,
  operation_enabled,
  quick_stop_active,
  fault_reaction_active,
  fault,
  undefined,  // bits that match none of the above
};
PowerState power_state_of(std::uint16_t statusword);
std::string_view describe(PowerState state);  // "switch on disabled"

// Statusword, object 0x6041: bits beyond the state.
inline constexpr std::uint16_t kStatusVoltageEnabled = 1 << 4, kStatusWarning = 1 << 7, kStatusRemote = 1 << 9,
                               kStatusTargetReached = 1 << 10, kStatusInternalLimit = 1 << 11,
                               kStatusSetPointAcknowledged = 1 << 12,  // profile position
    kStatusHomingAttained = 1 << 12,                                   // homing
    kStatusError = 1 << 13;                                            // following error; homing error

// Controlword, object 0x6040.
inline constexpr std::uint16_t kControlShutdown = 0x0006, kControlSwitchOn = 0x0007, kControlEnable = 0x000f,
                               kControlQuickStop = 0x0002, kControlDisableVoltage = 0x0000, kControlFaultReset = 0x0080;
inline constexpr std::uint16_t kControlNewSetPoint = 1 << 4,  // profile position; starts homing
    kControlChangeAtOnce = 1 << 5,                            // profile position: replace the set-point under way
    kControlHalt = 1 << 8;

// Returns the controlword that leads from `state` one transition closer to operation enabled; in fault, 0 and the fault
// reset alternate, because the reset acts on the rising edge of bit 7 (`previous` is the last controlword sent).
// Returns 0 in states without a way on (not ready, fault reaction, undefined). Quick stop active is left by "disable
// voltage".
std::uint16_t control_towards_operation(PowerState state, std::uint16_t previous);

// Modes of operation, object 0x6060, and their bits in 0x6502 (supported drive modes).
enum class DriveMode : std::int8_t {
  profile_position = 1,
  profile_velocity = 3,
  homing = 6,
  cyclic_position = 8,
  cyclic_velocity = 9,
};
std::string_view describe(DriveMode mode);  // "cyclic velocity"
bool is_supported(DriveMode mode, std::uint32_t supported_drive_modes);
bool is_position(DriveMode mode);  // of the two that hrt's flippers use; homing is neither

// Hands a new target to a drive in profile position mode: the set-point handshake of bits 4 and 5 of the controlword
// and bit 12 of the statusword, with "change at once", so that a newer target replaces the active one. A drive that has
// left operation enabled has dropped its target: start with a new handshake.
class SetPointHandshake {
 public:
  // Returns the bits to add to kControlEnable along with `target`; one call per cycle.
  std::uint16_t step(std::int32_t target, std::uint16_t statusword);

 private:
  bool begun_ = false, raised_ = false;
  std::int32_t handed_over_ = 0;
};

// Objects of the profile that this project reads and writes.
namespace object {
inline constexpr MappedObject controlword{{0x6040, 0}, ObjectType::unsigned16},
    statusword{{0x6041, 0}, ObjectType::unsigned16}, quick_stop_option{{0x605a, 0}, ObjectType::integer16},
    abort_connection_option{{0x6007, 0}, ObjectType::integer16},
    fault_reaction_option{{0x605e, 0}, ObjectType::integer16}, error_code{{0x603f, 0}, ObjectType::unsigned16},
    mode{{0x6060, 0}, ObjectType::integer8}, mode_display{{0x6061, 0}, ObjectType::integer8},
    supported_modes{{0x6502, 0}, ObjectType::unsigned32}, position_actual{{0x6064, 0}, ObjectType::integer32},
    velocity_actual{{0x606c, 0}, ObjectType::integer32}, target_position{{0x607a, 0}, ObjectType::integer32},
    target_velocity{{0x60ff, 0}, ObjectType::integer32}, current_actual{{0x6078, 0}, ObjectType::integer16},
    dc_link_voltage{{0x6079, 0}, ObjectType::unsigned32}, rated_current{{0x6075, 0}, ObjectType::unsigned32},
    home_offset{{0x607c, 0}, ObjectType::integer32}, position_limit_min{{0x607d, 1}, ObjectType::integer32},
    position_limit_max{{0x607d, 2}, ObjectType::integer32}, max_profile_velocity{{0x607f, 0}, ObjectType::unsigned32},
    profile_velocity{{0x6081, 0}, ObjectType::unsigned32}, profile_acceleration{{0x6083, 0}, ObjectType::unsigned32},
    profile_deceleration{{0x6084, 0}, ObjectType::unsigned32},
    quick_stop_deceleration{{0x6085, 0}, ObjectType::unsigned32}, homing_method{{0x6098, 0}, ObjectType::integer8},
    homing_speed_switch{{0x6099, 1}, ObjectType::unsigned32}, homing_speed_zero{{0x6099, 2}, ObjectType::unsigned32},
    homing_acceleration{{0x609a, 0}, ObjectType::unsigned32}, interpolation_period{{0x60c2, 1}, ObjectType::unsigned8},
    interpolation_exponent{{0x60c2, 2}, ObjectType::integer8};
}  // namespace object

// Quick stop option code: slow down on the quick stop ramp and stay in quick stop active, with torque, so that flippers
// keep holding the robot.
inline constexpr std::int16_t kQuickStopAndStay = 6;
// Abort connection option code: the same quick stop on loss of the master's heartbeat or of the bus.
inline constexpr std::int16_t kAbortByQuickStop = 3;

}  // namespace kenaf::canopen
