#include "can/canbus/device_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <utility>
#include <vector>

#include "formats/description/description_file.hpp"
#include "formats/description/toml_reader.hpp"

namespace kenaf::canbus {
namespace {

using description::TomlReader;

constexpr double kLongestBoot_s = 120;
constexpr int kMostCyclesBetweenCommands = 5, kMostResetCycles = 50;

template <typename Enum>
using Choice = std::pair<std::string_view, Enum>;

constexpr std::array kErrorControls = std::to_array<Choice<ErrorControl>>(
    {{"heartbeat", ErrorControl::heartbeat}, {"node guarding", ErrorControl::node_guarding}});
constexpr std::array kMappings =
    std::to_array<Choice<Mapping>>({{"written", Mapping::written}, {"cia402", Mapping::cia402}});
constexpr std::array kModeChanges =
    std::to_array<Choice<ModeChange>>({{"enabled", ModeChange::enabled}, {"disabled", ModeChange::disabled}});
constexpr std::array kVelocities = std::to_array<Choice<VelocitySign>>({{"signed", VelocitySign::two_complement},
                                                                        {"16 bits", VelocitySign::low_16_bits},
                                                                        {"magnitude", VelocitySign::magnitude}});

// Each of these leaves `value` alone if the file has no such key.
template <typename Enum, std::size_t count>
void read_key(TomlReader& file, std::string_view key, Enum& value, const std::array<Choice<Enum>, count>& choices) {
  if (!file.has(key)) return;
  const std::string text = file.text(key);
  std::vector<std::string> words;
  for (const auto& [word, meaning] : choices) {
    if (text == word) {
      value = meaning;
      return;
    }
    words.push_back(fmt::format("\"{}\"", word));
  }
  file.fail(key, fmt::format("is \"{}\", but must be {}", text, fmt::join(words, " or ")));
}

void read_key(TomlReader& file, std::string_view key, bool& value) {
  if (file.has(key)) value = file.boolean(key);
}

void read_key(TomlReader& file, std::string_view key, int& value, int min, int max) {
  if (file.has(key)) value = file.integer(key, min, max);
}

}  // namespace

Device parse_device(std::string_view toml_text, const std::string& name, const std::string& name_for_errors) {
  const toml::table root = description::parse_toml(toml_text, name_for_errors);
  TomlReader file(root, "", name_for_errors);
  Device device{.name = name};

  device.boot_s = file.number_or("boot_s", 0, {.min = 0, .max = kLongestBoot_s});
  read_key(file, "error_control", device.error_control, kErrorControls);
  read_key(file, "mapping", device.mapping, kMappings);
  read_key(file, "mapping_count_first", device.mapping_count_first);
  read_key(file, "command_pdo", device.command_pdo, 1, 4);
  read_key(file, "command_every", device.command_every, 1, kMostCyclesBetweenCommands);
  read_key(file, "mode_change", device.mode_change, kModeChanges);
  read_key(file, "halt_blocks_mode", device.halt_blocks_mode);
  read_key(file, "zero_target_by_sdo", device.zero_target_by_sdo);
  read_key(file, "fault_reset_cycles", device.fault_reset_cycles, 1, kMostResetCycles);
  read_key(file, "velocity", device.velocity, kVelocities);
  read_key(file, "position_bits", device.position_bits, 8, 32);
  read_key(file, "currents", device.currents);
  read_key(file, "battery", device.battery);
  if (file.has("home_offset_direction")) {
    device.home_offset_direction = file.integer("home_offset_direction", -1, 1);
    if (device.home_offset_direction == 0) file.fail("home_offset_direction", "is 0, but must be 1 or -1");
  }

  // A fixed mapping decides on the PDO, and has no place for a current.
  if (device.mapping == Mapping::cia402) {
    if (file.has("command_pdo")) file.fail("command_pdo", "is the mapping's own with mapping = \"cia402\"");
    if (file.has("currents") && device.currents)
      file.fail("currents", "is true, but with mapping = \"cia402\" no PDO has the current");
    device.currents = false;
    if (file.has("battery") && device.battery)
      file.fail("battery", "is true, but with mapping = \"cia402\" no PDO has the supply's voltage");
    device.battery = false;
  }
  file.finish();
  return device;
}

Device load_device(const std::string& name_or_path) {
  const description::DescriptionFile file = description::read_description_file("device", name_or_path, ".toml");
  return parse_device(file.text, name_or_path, file.path);
}

std::string advice(const Device& device, std::string_view setting) {
  if (device.name.empty())
    return fmt::format("; `{}` in a device file, which `device` in [can] names, is for drives that need it", setting);
  return fmt::format("; `{}` in its device file ({}) is for drives that need it", setting, device.name);
}

}  // namespace kenaf::canbus
