// Any text is an effect's or a physics setting's assignment, within its range, or is refused with an invalid_argument.
// A number of an option or a variable is what other readers read, or is refused.
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

#include "formats/settings/numbers.hpp"
#include "gap/datasets/physics_settings.hpp"
#include "physics/effects.hpp"

using namespace kenaf;

namespace {

void check_effect(std::string_view text) {
  physics::Effects effects;
  try {
    physics::set_effect(effects, text);
  } catch (const std::invalid_argument&) {
    if (effects != physics::Effects{}) __builtin_trap();
    return;
  }
  for (const physics::EffectInfo& effect : physics::effect_catalogue())
    for (const physics::EffectParameter& parameter : effect.parameters)
      if (const double value = effects.*(parameter.value); !(value >= parameter.min && value <= parameter.max))
        __builtin_trap();
}

void check_physics(std::string_view text) {
  physics::PhysicsSettings settings;
  try {
    gap::datasets::set_physics(settings, text);
  } catch (const std::invalid_argument&) {
    return;
  }
  if (!(settings.time_step_s > 0 && settings.solver_iterations > 0 && settings.contact_stiffness_npm > 0 &&
        settings.contact_damping_nspm >= 0))
    __builtin_trap();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  check_effect(text);
  check_physics(text);
  if (const auto whole = settings::whole_number_from(text); whole && std::to_string(*whole) != text) __builtin_trap();
  if (const auto number = settings::number_from(text); number && *number != std::stod(text)) __builtin_trap();
  return 0;
}
