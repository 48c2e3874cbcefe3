// A drive's device file: any text gives a device within its ranges, or an error with a place.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "can/canbus/device_file.hpp"
#include "formats/description/description_error.hpp"
#include "tests/fuzz/can_input.hpp"

using namespace kenaf;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const canbus::Device device =
        canbus::parse_device({reinterpret_cast<const char*>(data), size}, "fuzz", "fuzz.toml");
    fuzz::require(device.boot_s >= 0 && device.boot_s <= 120);
    fuzz::require(device.command_pdo >= 1 && device.command_pdo <= 4 && device.command_every >= 1);
    fuzz::require(device.fault_reset_cycles >= 1);
    fuzz::require(device.position_bits >= 8 && device.position_bits <= 32);
    fuzz::require(device.home_offset_direction == 1 || device.home_offset_direction == -1);
  } catch (const description::DescriptionError& error) {
    fuzz::require(std::string_view(error.what()).starts_with("fuzz.toml"));
  }
  return 0;
}
