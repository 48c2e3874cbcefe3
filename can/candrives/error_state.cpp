#include "can/candrives/error_state.hpp"

#include <utility>

namespace kenaf::candrives {

std::uint8_t register_bit_of(std::uint16_t error_code) {
  switch (error_code >> 12) {
    case 0x2:
      return kErrorCurrent;
    case 0x3:
      return kErrorVoltage;
    case 0x4:
      return kErrorTemperature;
    case 0xf:
      return kErrorManufacturer;
  }
  switch (error_code >> 8) {
    case 0x81:
    case 0x82:
      return kErrorCommunication;
    case 0x84:
    case 0x85:
    case 0x86:
      return kErrorDeviceProfile;
  }
  return 0;
}

void ErrorState::raise(std::uint16_t error_code) {
  const auto bits = static_cast<std::uint8_t>(kErrorGeneric | register_bit_of(error_code));
  if (present_.emplace(error_code, bits).second) say(error_code);
}

// "Error reset or no error": its register shows the remaining errors.
void ErrorState::clear(std::uint16_t error_code) {
  if (present_.erase(error_code) > 0) say(canopen::kErrorNone);
}

void ErrorState::reset() {
  present_.clear();
  messages_.clear();
}

std::uint8_t ErrorState::error_register() const {
  std::uint8_t bits = 0;
  for (const auto& [code, of_code] : present_) bits |= of_code;
  return bits;
}

void ErrorState::say(std::uint16_t error_code) {
  messages_.push_back(
      encode(canopen::Emergency{.node = node_, .error_code = error_code, .error_register = error_register()}));
}

std::vector<canopen::Frame> ErrorState::take_messages() {
  return std::exchange(messages_, {});
}

}  // namespace kenaf::candrives
