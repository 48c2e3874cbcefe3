#include "libkenaf_real/advice.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "can/canopen/device.hpp"

namespace kenaf::real {
namespace {

using canbus::Device;
using canopen::ObjectAddress;
using canopen::SdoAbort;
namespace object = canopen::object;

constexpr std::uint16_t kFirstReceiveMapping = 0x1600;

bool is_record_of_pdo(ObjectAddress at, std::uint16_t first_receive, std::uint16_t first_transmit) {
  constexpr std::uint16_t kRecords = 0x200;
  return (at.index >= first_receive && at.index < first_receive + kRecords) ||
         (at.index >= first_transmit && at.index < first_transmit + kRecords);
}

// An object that CiA 402 leaves optional, as a mapping entry, and the key that does without it.
std::string_view key_without(std::int64_t mapping_entry) {
  if (mapping_entry == canopen::mapping_entry(object::dc_link_voltage)) return "battery";
  if (mapping_entry == canopen::mapping_entry(object::current_actual)) return "currents";
  return {};
}

bool is_missing(SdoAbort abort) {
  return abort == SdoAbort::no_object || abort == SdoAbort::no_sub_index;
}

}  // namespace

std::string advice_on_refusal(const Device& device, const SdoRefused& refused) {
  const ObjectAddress at = refused.object;
  if ((at == object::consumer_heartbeat_1.object || at == object::producer_heartbeat_ms.object) &&
      is_missing(refused.abort))
    return advice(device, "error_control = \"node guarding\"");
  if (at == object::mode.object && !is_missing(refused.abort)) return advice(device, "halt_blocks_mode = true");
  // An entry's object does not exist, or cannot be in a PDO; the count or the identifier cannot be changed now.
  const bool is_of_command = at.index >= kFirstReceiveMapping && at.index < kFirstReceiveMapping + 4;
  const std::string of_mapping =
      advice(device, "mapping = \"cia402\"") + (is_of_command ? advice(device, "command_pdo = 2 (to 4)") : "");
  if (is_record_of_pdo(at, kFirstReceiveMapping, 0x1a00) && at.sub > 0) {
    const std::string_view key = key_without(refused.value);
    if (key.empty()) return of_mapping;
    return fmt::format("; where its drives have no such object: `{} = false` in [can] or in a device file", key) +
           of_mapping;
  }
  if (is_record_of_pdo(at, kFirstReceiveMapping, 0x1a00) && !is_missing(refused.abort)) return of_mapping;
  if (is_record_of_pdo(at, 0x1400, 0x1800) && at.sub == 1 && !is_missing(refused.abort))
    return advice(device, "mapping_count_first = true");
  return {};
}

std::string advice_on_refusal_when_enabled(const Device& device, const SdoRefused& refused) {
  if (refused.object != object::mode.object || is_missing(refused.abort)) return {};
  return advice(device, "mode_change = \"disabled\"");
}

std::string advice_on_state(const Device& device, canopen::PowerState state,
                            const std::optional<canopen::Emergency>& emergency) {
  if (const std::string words = advice_on_emergency(device, emergency); !words.empty()) return words;
  return state == canopen::PowerState::fault ? advice(device, "fault_reset_cycles = 5") : std::string();
}

std::string advice_on_emergency(const Device& device, const std::optional<canopen::Emergency>& emergency) {
  const bool overrun = emergency && emergency->error_code == canopen::kErrorOverrun;
  return overrun ? advice(device, "command_every = 3") : std::string();
}

std::string advice_on_boot(const canbus::RobotBus& bus, const std::vector<NamedNode>& missing) {
  const auto drive = std::ranges::find_if(bus.drives, [&](const canbus::DriveOnBus& one) {
    return std::ranges::any_of(missing, [&](const NamedNode& node) { return node.node == one.node; });
  });
  return drive == bus.drives.end() ? std::string() : advice(drive->device, "boot_s = 12");
}

}  // namespace kenaf::real
