#include "can/candrives/power_states.hpp"

#include <utility>

namespace kenaf::candrives {

using canopen::PowerState;

DriveOrder order_of(std::uint16_t controlword) {
  if ((controlword & canopen::kControlFaultReset) != 0) return DriveOrder::none;
  if ((controlword & 0x02) == 0) return DriveOrder::disable_voltage;
  if ((controlword & 0x04) == 0) return DriveOrder::quick_stop;
  if ((controlword & 0x01) == 0) return DriveOrder::shutdown;
  return (controlword & 0x08) == 0 ? DriveOrder::switch_on : DriveOrder::enable;
}

bool PowerStates::is_powered() const {
  return state_ == PowerState::operation_enabled || state_ == PowerState::quick_stop_active ||
         state_ == PowerState::fault_reaction_active;
}

// CiA 402-2, statusword: bits 0 to 3, 5 and 6 by state. Bit 5 is 0 while a quick stop is active or requested.
std::uint16_t PowerStates::statusword_bits() const {
  switch (state_) {
    case PowerState::switch_on_disabled:
      return 0x0040;
    case PowerState::ready_to_switch_on:
      return 0x0021;
    case PowerState::switched_on:
      return 0x0023;
    case PowerState::operation_enabled:
      return 0x0027;
    case PowerState::quick_stop_active:
      return 0x0007;
    case PowerState::fault_reaction_active:
      return 0x000f;
    case PowerState::fault:
      return 0x0008;
    case PowerState::not_ready:
    case PowerState::undefined:
      break;
  }
  return 0;
}

void PowerStates::reset() {
  state_ = PowerState::not_ready;
  last_word_ = 0;
}

void PowerStates::self_test_passed() {
  if (state_ == PowerState::not_ready) state_ = PowerState::switch_on_disabled;
}

void PowerStates::on_controlword(std::uint16_t controlword) {
  const std::uint16_t last = std::exchange(last_word_, controlword);
  const DriveOrder order = order_of(controlword);
  switch (state_) {
    case PowerState::switch_on_disabled:
      if (order == DriveOrder::shutdown) state_ = PowerState::ready_to_switch_on;  // 2
      return;
    case PowerState::ready_to_switch_on:
      if (order == DriveOrder::switch_on) state_ = PowerState::switched_on;                            // 3
      if (order == DriveOrder::enable) state_ = PowerState::operation_enabled;                         // 3 and 4
      if (order == DriveOrder::disable_voltage || order == DriveOrder::quick_stop) disable_voltage();  // 7
      return;
    case PowerState::switched_on:
      if (order == DriveOrder::enable) state_ = PowerState::operation_enabled;                         // 4
      if (order == DriveOrder::shutdown) state_ = PowerState::ready_to_switch_on;                      // 6
      if (order == DriveOrder::disable_voltage || order == DriveOrder::quick_stop) disable_voltage();  // 10
      return;
    case PowerState::operation_enabled:
      if (order == DriveOrder::switch_on) state_ = PowerState::switched_on;        // 5
      if (order == DriveOrder::shutdown) state_ = PowerState::ready_to_switch_on;  // 8
      if (order == DriveOrder::disable_voltage) disable_voltage();                 // 9
      if (order == DriveOrder::quick_stop) quick_stop();                           // 11
      return;
    case PowerState::quick_stop_active:
      if (order == DriveOrder::disable_voltage) disable_voltage();  // 12
      if (order == DriveOrder::enable && order_of(last) != DriveOrder::enable)
        state_ = PowerState::operation_enabled;  // 16
      return;
    case PowerState::fault: {
      const bool edge = (controlword & ~last & canopen::kControlFaultReset) != 0;
      if (edge) state_ = PowerState::switch_on_disabled;  // 15
      return;
    }
    case PowerState::not_ready:
    case PowerState::fault_reaction_active:
    case PowerState::undefined:
      return;
  }
}

void PowerStates::quick_stop() {
  if (state_ == PowerState::operation_enabled) state_ = PowerState::quick_stop_active;
}

void PowerStates::disable_voltage() {
  switch (state_) {
    case PowerState::ready_to_switch_on:
    case PowerState::switched_on:
    case PowerState::operation_enabled:
    case PowerState::quick_stop_active:
      state_ = PowerState::switch_on_disabled;
      return;
    default:
      return;
  }
}

void PowerStates::fault() {
  if (state_ != PowerState::fault) state_ = PowerState::fault_reaction_active;
}

void PowerStates::reaction_done() {
  if (state_ == PowerState::fault_reaction_active) state_ = PowerState::fault;
}

}  // namespace kenaf::candrives
