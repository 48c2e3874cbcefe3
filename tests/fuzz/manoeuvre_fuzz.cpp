// Any text is a file of manoeuvres or is refused with a DescriptionError; what is accepted has phases that end.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "physics/robot_description.hpp"
#include "rollout/manoeuvre.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const auto all = kenaf::rollout::parse_manoeuvres({reinterpret_cast<const char*>(data), size}, "fuzz.toml");
    if (all.empty()) __builtin_trap();
    for (const auto& manoeuvre : all) {
      if (!(manoeuvre.at_most_s() > 0 && manoeuvre.at_most_s() <= 3600)) __builtin_trap();
      if (manoeuvre.phases.front().give_up || manoeuvre.phases.back().give_up) __builtin_trap();
    }
  } catch (const kenaf::description::DescriptionError&) {
  }
  return 0;
}
