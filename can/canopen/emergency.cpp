#include "can/canopen/emergency.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace kenaf::canopen {
namespace {

// Object 0x1001, bits 0 to 7: CiA 301, 7.5.2.2.
constexpr std::array<std::string_view, 8> kErrorRegisterBits{
    "generic", "current", "voltage", "temperature", "communication", "device profile", "reserved", "manufacturer"};

}  // namespace

Frame encode(const Emergency& emergency) {
  std::array<std::uint8_t, 8> data{};
  put(data, 0, 2, emergency.error_code);
  data[2] = emergency.error_register;
  std::ranges::copy(emergency.manufacturer_bytes, data.begin() + 3);
  return make_frame(static_cast<std::uint16_t>(kEmergencyId + emergency.node), data);
}

std::optional<Emergency> emergency_from(const Frame& frame) {
  if (frame.id <= kEmergencyId || frame.id > kEmergencyId + kMaxNode || frame.length != 8) return std::nullopt;
  Emergency emergency{.node = static_cast<NodeId>(frame.id - kEmergencyId),
                      .error_code = static_cast<std::uint16_t>(get_unsigned(frame.data, 0, 2)),
                      .error_register = frame.data[2]};
  std::copy(frame.data.begin() + 3, frame.data.end(), emergency.manufacturer_bytes.begin());
  return emergency;
}

std::string describe(const Emergency& emergency) {
  std::string set;
  for (std::size_t bit = 0; bit < kErrorRegisterBits.size(); ++bit)
    if ((emergency.error_register >> bit & 1) != 0)
      set += fmt::format("{}{}", set.empty() ? ": " : ", ", kErrorRegisterBits[bit]);
  return fmt::format("{:#06x} {} (error register {:#04x}{}; manufacturer {:02x})", emergency.error_code,
                     error_code_words(emergency.error_code), emergency.error_register, set,
                     fmt::join(emergency.manufacturer_bytes, " "));
}

}  // namespace kenaf::canopen
