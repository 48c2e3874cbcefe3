// A node's errors: which are there now, the error register that they make, and the emergency messages that say so when
// one comes and when one goes. CiA 301, 7.2.7.
#pragma once

#include <map>
#include <vector>

#include "can/canopen/emergency.hpp"

namespace kenaf::candrives {

// Bits of the error register, object 0x1001. The generic bit is set with any other. CiA 301, 7.5.2.2.
inline constexpr std::uint8_t kErrorGeneric = 0x01, kErrorCurrent = 0x02, kErrorVoltage = 0x04,
                              kErrorTemperature = 0x08, kErrorCommunication = 0x10, kErrorDeviceProfile = 0x20,
                              kErrorManufacturer = 0x80;
// The bit of an error code's class: 0x2xxx current, 0x3xxx voltage, 0x4xxx temperature, 0x81xx and 0x82xx
// communication, 0x84xx to 0x86xx device profile, 0xFxxx manufacturer; none of another. CiA 301, table 26; CiA 402-2,
// error codes.
std::uint8_t register_bit_of(std::uint16_t error_code);

class ErrorState {
 public:
  explicit ErrorState(canopen::NodeId node) : node_(node) {}

  // An error that is there already, or is not there to go, changes nothing.
  void raise(std::uint16_t error_code);
  void clear(std::uint16_t error_code);
  // Gone, unsaid: its cause was reset.
  void forget(std::uint16_t error_code) { present_.erase(error_code); }
  // All of them gone, unsaid: the node has started anew.
  void reset();

  std::uint8_t error_register() const;
  // What has not been sent yet, in order.
  std::vector<canopen::Frame> take_messages();

 private:
  void say(std::uint16_t error_code);

  canopen::NodeId node_;
  std::map<std::uint16_t, std::uint8_t> present_;  // error code to register bits
  std::vector<canopen::Frame> messages_;
};

}  // namespace kenaf::candrives
