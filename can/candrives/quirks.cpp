#include "can/candrives/quirks.hpp"

#include <utility>

namespace kenaf::candrives {
namespace {

constexpr std::pair<FaultKind, bool Quirks::*> kSwitches[] = {
    {FaultKind::slow_boot, &Quirks::slow_boot},
    {FaultKind::guarding_only, &Quirks::guarding_only},
    {FaultKind::count_first, &Quirks::count_first},
    {FaultKind::fixed_mapping, &Quirks::fixed_mapping},
    {FaultKind::first_rpdo_fixed, &Quirks::first_rpdo_fixed},
    {FaultKind::slow_commands, &Quirks::slow_commands},
    {FaultKind::mode_locked, &Quirks::mode_locked},
    {FaultKind::halt_blocks_mode, &Quirks::halt_blocks_mode},
    {FaultKind::old_target, &Quirks::old_target},
    {FaultKind::slow_fault_reset, &Quirks::slow_fault_reset},
    {FaultKind::velocity_unsigned, &Quirks::velocity_unsigned},
    {FaultKind::velocity_16_bits, &Quirks::velocity_16_bits},
    {FaultKind::no_current, &Quirks::no_current},
    {FaultKind::no_voltage, &Quirks::no_voltage},
    {FaultKind::home_offset_negative, &Quirks::home_offset_negative},
    {FaultKind::missing_commands_fault, &Quirks::missing_commands_fault},
};

}  // namespace

bool switch_on(Quirks& quirks, FaultKind fault) {
  if (fault == FaultKind::position_16_bits || fault == FaultKind::position_24_bits) {
    quirks.position_bits = fault == FaultKind::position_16_bits ? 16 : 24;
    return true;
  }
  for (const auto& [kind, quirk] : kSwitches) {
    if (kind != fault) continue;
    quirks.*quirk = true;
    return true;
  }
  return false;
}

}  // namespace kenaf::candrives
