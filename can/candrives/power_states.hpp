// The power state machine of a drive, from the drive's side: controlword in, state and the state's statusword bits out.
// The diagram is in can/canopen/drive.hpp; transition numbers are those of CiA 402-2 (IEC 61800-7-201), 10.
#pragma once

#include <cstdint>

#include "can/canopen/drive.hpp"

namespace kenaf::candrives {

// Command in bits 0 to 3 and 7 of a controlword. A word with bit 7 and any others is a command only in the state
// "fault".
enum class DriveOrder : std::uint8_t { none, shutdown, switch_on, enable, disable_voltage, quick_stop };
DriveOrder order_of(std::uint16_t controlword);

class PowerStates {
 public:
  canopen::PowerState state() const { return state_; }
  // True if the motor is fed and may turn: operation enabled, quick stop active, fault reaction active.
  bool is_powered() const;
  std::uint16_t statusword_bits() const;

  // Power on. The drive's self-test then lasts until self_test_passed: transitions 0 and 1.
  void reset();
  void self_test_passed();

  // Transitions 2 to 12, 15 and 16; one transition per controlword, except 3 and 4, which "enable" makes together.
  //
  // Quick stop active returns to operation enabled (16) only on a new "enable": a master that repeats itself while its
  // drive stops for an internal reason must not restart it.
  void on_controlword(std::uint16_t controlword);

  // Initiated by the drive itself:
  void quick_stop();       // 11, if operation is enabled
  void disable_voltage();  // 7, 9, 10, 12: the motor is no longer fed
  void fault();            // 13, unless already in fault
  void reaction_done();    // 14

 private:
  canopen::PowerState state_ = canopen::PowerState::not_ready;
  std::uint16_t last_word_ = 0;
};

}  // namespace kenaf::candrives
