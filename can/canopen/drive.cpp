#include "can/canopen/drive.hpp"

namespace kenaf::canopen {

// Bits 0 to 3, 5 and 6 give the state; some states leave bit 5 (no quick stop) undefined. CiA 402-2, statusword, state
// coding.
PowerState power_state_of(std::uint16_t statusword) {
  switch (statusword & 0x4f) {
    case 0x00:
      return PowerState::not_ready;
    case 0x40:
      return PowerState::switch_on_disabled;
    case 0x0f:
      return PowerState::fault_reaction_active;
    case 0x08:
      return PowerState::fault;
  }
  switch (statusword & 0x6f) {
    case 0x21:
      return PowerState::ready_to_switch_on;
    case 0x23:
      return PowerState::switched_on;
    case 0x27:
      return PowerState::operation_enabled;
    case 0x07:
      return PowerState::quick_stop_active;
  }
  return PowerState::undefined;
}

std::string_view describe(PowerState state) {
  switch (state) {
    case PowerState::not_ready:
      return "not ready to switch on";
    case PowerState::switch_on_disabled:
      return "switch on disabled";
    case PowerState::ready_to_switch_on:
      return "ready to switch on";
    case PowerState::switched_on:
      return "switched on";
    case PowerState::operation_enabled:
      return "operation enabled";
    case PowerState::quick_stop_active:
      return "quick stop active";
    case PowerState::fault_reaction_active:
      return "fault reaction active";
    case PowerState::fault:
      return "fault";
    case PowerState::undefined:
      break;
  }
  return "undefined state";
}

std::uint16_t control_towards_operation(PowerState state, std::uint16_t previous) {
  switch (state) {
    case PowerState::switch_on_disabled:
      return kControlShutdown;  // transition 2
    case PowerState::ready_to_switch_on:
      return kControlSwitchOn;  // 3
    case PowerState::switched_on:
    case PowerState::operation_enabled:
      return kControlEnable;  // 4
    case PowerState::fault:
      return (previous & kControlFaultReset) != 0 ? std::uint16_t{0} : kControlFaultReset;  // 15
    case PowerState::quick_stop_active:  // 12; 16, back to operation enabled, is optional and not used here
    case PowerState::not_ready:
    case PowerState::fault_reaction_active:
    case PowerState::undefined:
      break;
  }
  return kControlDisableVoltage;
}

std::string_view describe(DriveMode mode) {
  switch (mode) {
    case DriveMode::profile_position:
      return "profile position";
    case DriveMode::profile_velocity:
      return "profile velocity";
    case DriveMode::homing:
      return "homing";
    case DriveMode::cyclic_position:
      return "cyclic position";
    case DriveMode::cyclic_velocity:
      return "cyclic velocity";
  }
  return "unknown mode";
}

bool is_supported(DriveMode mode, std::uint32_t supported_drive_modes) {
  return (supported_drive_modes >> (static_cast<int>(mode) - 1) & 1) != 0;
}

bool is_position(DriveMode mode) {
  return mode == DriveMode::profile_position || mode == DriveMode::cyclic_position;
}

std::uint16_t SetPointHandshake::step(std::int32_t target, std::uint16_t statusword) {
  const bool acknowledged = (statusword & kStatusSetPointAcknowledged) != 0;
  if (raised_) {
    raised_ = !acknowledged;
  } else if (!acknowledged && (!begun_ || target != handed_over_)) {
    // the drive takes the target present at the edge: a later change needs a new edge
    begun_ = raised_ = true;
    handed_over_ = target;
  }
  return static_cast<std::uint16_t>(kControlChangeAtOnce | (raised_ ? kControlNewSetPoint : 0));
}

}  // namespace kenaf::canopen
