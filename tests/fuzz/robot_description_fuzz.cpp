// Any text is a robot description or is refused with a DescriptionError; what is accepted can be placed in a world.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "physics/robot_description.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const auto robot = kenaf::physics::parse_robot({reinterpret_cast<const char*>(data), size}, "fuzz.toml");
    if (!(robot.total_mass_kg() > 0) || !(robot.track_gauge_m() > 0)) __builtin_trap();
  } catch (const kenaf::description::DescriptionError&) {
  }
  return 0;
}
