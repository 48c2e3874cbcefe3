// A node's errors: those present, the resulting error register, and the emergency messages sent when an error occurs or
// disappears. CiA 301, 7.2.7.
#pragma once

#include <map>
#include <vector>

#include "can/canopen/emergency.hpp"

namespace kenaf::candrives {

// Bits of the error register, object 0x1001. The generic bit is set with any other. CiA 301, 7.5.2.2.
inline constexpr std::uint8_t kErrorGeneric = 0x01, kErrorCurrent = 0x02, kErrorVoltage = 0x04,
                              kErrorTemperature = 0x08, kErrorCommunication = 0x10, kErrorDeviceProfile = 0x20,
                              kErrorManufacturer = 0x80;
// Returns the bit of an error code's class: 0x2xxx current, 0x3xxx voltage, 0x4xxx temperature, 0x81xx and 0x82xx
// communication, 0x84xx to 0x86xx device profile, 0xFxxx manufacturer; none for others. CiA 301, table 26; CiA 402-2,
// error codes.
std::uint8_t register_bit_of(std::uint16_t error_code);

class ErrorState {
 public:
  explicit ErrorState(canopen::NodeId node) : node_(node) {}

  // Raising a present error, or clearing an absent one, changes nothing.
  void raise(std::uint16_t error_code);
  void clear(std::uint16_t error_code);
  // Removes it without a message: its cause was reset.
  void forget(std::uint16_t error_code) { present_.erase(error_code); }
  // Removes all without a message: the node has restarted.
  void reset();

  std::uint8_t error_register() const;
  // Returns the messages not yet sent, in order.
  std::vector<canopen::Frame> take_messages();

 private:
  void say(std::uint16_t error_code);

  canopen::NodeId node_;
  std::map<std::uint16_t, std::uint8_t> present_;  // error code to register bits
  std::vector<canopen::Frame> messages_;
};

}  // namespace kenaf::candrives
