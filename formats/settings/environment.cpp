#include "formats/settings/environment.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <vector>

#include "formats/settings/nearest_word.hpp"

namespace kenaf::settings {
namespace {

constexpr std::string_view kPrefix = "KENAF_";

using enum Variable::Reader;
constexpr std::array kVariables = std::to_array<Variable>({
    {"KENAF_CONFIG", library, "the configuration file; empty: the first one found"},
    {"KENAF_RELAY", library, "address of the relay"},
    {"KENAF_CAN_INTERFACE", library, "interface of the CAN bus"},
    {"KENAF_ROBOT", library, "description of the robot on the CAN bus"},
    {"KENAF_RECORD", library, "file to record the run in"},
    {"KENAF_CAMERA_SERVER", library, "address of the server of camera pictures"},
    {"KENAF_LOCKSTEP", library, "whether the simulation waits for the program"},
    {"KENAF_RESET_ROBOT", library, "whether the simulated robot is put back to its start"},
    {"KENAF_PERIOD_S", library, "period of the cycle"},
    {"KENAF_COMMAND_TIMEOUT_S", library, "robot time after which a silent program's robot stops"},
    {"KENAF_LINK_TIMEOUT_S", library, "silence after which the link is lost"},
    {"KENAF_CONNECT_TIMEOUT_S", library, "longest wait for the robot's first state"},
    {"KENAF_CAN_TIMEOUT_S", library, "longest wait for the devices on the CAN bus"},
    {"KENAF_HOLD_S", library, "how long an answer is held back"},
    {"KENAF_MAX_SPEED_MMPS", library, "largest speed of a motion"},
    {"KENAF_ACCELERATION_MMPS2", library, "acceleration of a motion"},
    {"KENAF_MAX_TURN_DEGPS", library, "largest turn rate of a motion"},
    {"KENAF_TURN_ACCELERATION_DEGPS2", library, "acceleration of a turn"},
    {"KENAF_DISTANCE_TOLERANCE_MM", library, "when a distance is reached"},
    {"KENAF_ANGLE_TOLERANCE_DEG", library, "when an angle is reached"},
    {"KENAF_STUCK_TIME_S", library, "time without progress after which the robot is stuck"},
    {"KENAF_STUCK_CURRENT_A", library, "current from which on the robot is stuck"},
    {"KENAF_TRACK_GAUGE_MM", library, "distance of the tracks, where nothing measures the heading"},
    {"KENAF_TURN_EFFICIENCY", library, "share of a turn that slip leaves, where nothing measures the heading"},
    {"KENAF_DATA_DIR", programs, "folder with robots/, worlds/ or manoeuvres/ before the shipped ones"},
    {"KENAF_WORLD_PATH", programs, "folders with models, meshes and height maps of worlds, separated by colons"},
    {"KENAF_LIBRARY", python, "library of kenaf.hrt: sim or real"},
    {"KENAF_WORLD_OPTIONS", services, "options of kenaf-world.service"},
    {"KENAF_RELAYD_OPTIONS", services, "options of kenaf-relayd.service"},
    {"KENAF_PATIENCE_S", development, "how long a test waits for what must come"},
    {"KENAF_BIN_DIR", development, "folder of the programs that the tests of Python start"},
    {"KENAF_EMULATOR", development, "what runs programs for another machine"},
    {"KENAF_MARMOTTE_DATA", development, "folder of a real robot's recordings"},
    {"KENAF_VCAN_WAY", development, "how scripts/with-vcan.sh gets a CAN bus"},
    {"KENAF_VCAN_TIMEOUT", development, "limit of scripts/with-vcan.sh in seconds"},
    {"KENAF_VCAN_KERNEL_DEB", development, "kernel of the virtual machine of scripts/with-vcan.sh"},
    {"KENAF_VCAN_TEST", development, "what a test of scripts/with-vcan.sh looks for"},
});

// Without the prefix, which all share, so that its length does not make names alike.
std::vector<std::string> known_names() {
  std::vector<std::string> names;
  for (const Variable& variable : kVariables) {
    if (variable.reader != development) names.emplace_back(variable.name.substr(kPrefix.size()));
  }
  return names;
}

std::string unknown_variable(std::string_view name) {
  const std::vector<std::string> names = known_names();
  const std::string_view nearest = nearest_word(name.substr(kPrefix.size()), names);
  return fmt::format("environment variable {} is not known; {}", name,
                     nearest.empty() ? "unset it, or choose one of those that the user guide lists"
                                     : fmt::format("did you mean {}{}?", kPrefix, nearest));
}

}  // namespace

std::span<const Variable> known_variables() {
  return kVariables;
}

Environment own_environment() {
  Environment variables;
  for (char** entry = environ; entry != nullptr && *entry != nullptr; ++entry) {
    const std::string_view text = *entry;
    const std::size_t equals = text.find('=');
    // of a name that is set twice getenv() has the first value, and so has emplace()
    if (equals != std::string_view::npos) variables.emplace(text.substr(0, equals), text.substr(equals + 1));
  }
  return variables;
}

std::string wrong_variable(const Environment& environment) {
  for (auto at = environment.lower_bound(kPrefix); at != environment.end() && at->first.starts_with(kPrefix); ++at) {
    const auto& [name, value] = *at;
    if (std::ranges::find(kVariables, name, &Variable::name) == kVariables.end()) return unknown_variable(name);
    std::error_code ignored;
    if (name == "KENAF_DATA_DIR" && !value.empty() && !std::filesystem::is_directory(value, ignored))
      return fmt::format("environment variable KENAF_DATA_DIR={}: must be a folder", shown(value));
  }
  return {};
}

}  // namespace kenaf::settings
