// Any text is a world or is refused with a DescriptionError.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "physics/world_description.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // long ones would only be slow
  if (size > 8192) return 0;
  std::vector<std::string> unsupported;
  try {
    const auto world =
        kenaf::physics::parse_world({reinterpret_cast<const char*>(data), size}, "fuzz.sdf", "", unsupported);
    if (world.start_poses.empty()) __builtin_trap();
    for (const auto& box : world.boxes)
      if (!(box.size_m.minCoeff() > 0) || !box.X_WBox.p.allFinite()) __builtin_trap();
  } catch (const kenaf::description::DescriptionError&) {
  }
  return 0;
}
