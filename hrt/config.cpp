#include "hrt/config.hpp"

#include <fmt/format.h>

#include <toml++/toml.h>
#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <span>

#include "formats/settings/nearest_word.hpp"
#include "formats/settings/numbers.hpp"
#include "hrt/error.hpp"

namespace kenaf::hrt {
namespace {

constexpr std::uint32_t kCookie = 0x48'52'54'31;  // "HRT1"

struct NumberKey {
  const char* name;
  double hrt_config::*member;
  double minimum, maximum, standard;
};
constexpr NumberKey kNumberKeys[] = {
    {"period_s", &hrt_config::period_s, 0.001, 1, 0.01},
    {"command_timeout_s", &hrt_config::command_timeout_s, 0.01, 10, 0.1},
    {"link_timeout_s", &hrt_config::link_timeout_s, 0.05, 10, 0.5},
    {"connect_timeout_s", &hrt_config::connect_timeout_s, 0.05, 60, 3},
    {"max_speed_mmps", &hrt_config::max_speed_mmps, 1, 2000, 200},
    {"acceleration_mmps2", &hrt_config::acceleration_mmps2, 10, 10000, 400},
    {"max_turn_degps", &hrt_config::max_turn_degps, 1, 360, 45},
    {"turn_acceleration_degps2", &hrt_config::turn_acceleration_degps2, 10, 3600, 120},
    {"distance_tolerance_mm", &hrt_config::distance_tolerance_mm, 0.1, 100, 1},
    {"angle_tolerance_deg", &hrt_config::angle_tolerance_deg, 0.05, 10, 0.3},
    {"stuck_time_s", &hrt_config::stuck_time_s, 0.1, 60, 1},
    {"stuck_current_a", &hrt_config::stuck_current_a, 0, 1000, 0},
    {"track_gauge_mm", &hrt_config::track_gauge_mm, 50, 5000, 200},
    {"turn_efficiency", &hrt_config::turn_efficiency, 0.1, 2, 1},
    {"hold_s", &hrt_config::hold_s, 0, 0.2, 0.05},
    {"can_timeout_s", &hrt_config::can_timeout_s, 0.05, 60, 5},
};

struct FlagKey {
  const char* name;
  std::int32_t hrt_config::*member;
};
constexpr FlagKey kFlagKeys[] = {{"lockstep", &hrt_config::lockstep}, {"reset_robot", &hrt_config::reset_robot}};

// Members that are arrays of char, each with its size.
struct TextKey {
  const char* name;
  std::span<char> (*member)(hrt_config&);
  bool may_be_empty;
};
constexpr TextKey kTextKeys[] = {
    {"relay", [](hrt_config& c) { return std::span<char>(c.relay); }, false},
    {"can_interface", [](hrt_config& c) { return std::span<char>(c.can_interface); }, true},
    {"robot", [](hrt_config& c) { return std::span<char>(c.robot); }, false},
    {"record", [](hrt_config& c) { return std::span<char>(c.record); }, true},
    {"camera_server", [](hrt_config& c) { return std::span<char>(c.camera_server); }, false},
};

// Each set_... returns an error text, or an empty string once the value is set.

std::string set_number(const NumberKey& key, double value, hrt_config& config) {
  if (!(value >= key.minimum && value <= key.maximum)) {
    return fmt::format("{} must be from {} to {}, not {}", key.name, key.minimum, key.maximum, value);
  }
  config.*key.member = value;
  return {};
}

std::string set_text(const TextKey& key, std::string_view value, hrt_config& config) {
  const std::span<char> target = key.member(config);
  if (value.empty() && !key.may_be_empty) return fmt::format("{} must not be empty", key.name);
  if (value.size() >= target.size()) {
    return fmt::format("{} must have at most {} bytes, not {}", key.name, target.size() - 1, value.size());
  }
  if (value.find('\0') != std::string_view::npos) return fmt::format("{} must not contain a zero byte", key.name);
  std::ranges::fill(target, '\0');
  std::ranges::copy(value, target.begin());
  return {};
}

// Sets one key of the file. Returns an error text, or an empty string.
std::string set_from_toml(std::string_view name, const toml::node& node, hrt_config& config) {
  for (const NumberKey& key : kNumberKeys) {
    if (name != key.name) continue;
    if (!node.is_number()) return fmt::format("{} must be a number from {} to {}", name, key.minimum, key.maximum);
    // not value<double>(), which rejects integers beyond 2^53
    const double value = node.is_integer() ? static_cast<double>(**node.as_integer()) : **node.as_floating_point();
    return set_number(key, value, config);
  }
  for (const FlagKey& key : kFlagKeys) {
    if (name != key.name) continue;
    if (!node.is_boolean()) return fmt::format("{} must be true or false", name);
    config.*key.member = *node.value<bool>() ? 1 : 0;
    return {};
  }
  for (const TextKey& key : kTextKeys) {
    if (name != key.name) continue;
    if (!node.is_string()) return fmt::format("{} must be a string in quotes", name);
    return set_text(key, *node.value<std::string_view>(), config);
  }
  return fmt::format("unknown key '{}'{}; the keys are the members of hrt_config in hrt.h", name,
                     settings::did_you_mean(name, config_keys()));
}

std::optional<bool> flag_from(std::string_view text) {
  if (text == "true" || text == "1") return true;
  if (text == "false" || text == "0") return false;
  return std::nullopt;
}

// ASCII only: std::toupper depends on the program's locale.
char capital(char c) {
  return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
}

std::string variable_name(const char* key) {
  std::string name = "KENAF_";
  for (const char* c = key; *c != '\0'; ++c) name += capital(*c);
  return name;
}

std::filesystem::path file_that_applies(const Environment& environment) {
  const auto value_of = [&environment](const char* name) {
    const auto found = environment.find(name);
    return found == environment.end() ? std::string() : found->second;
  };
  if (const std::string named = value_of("KENAF_CONFIG"); !named.empty()) return named;
  std::error_code ignored;
  if (std::filesystem::exists("kenaf.toml", ignored)) return "kenaf.toml";
  if (const std::string home = value_of("HOME"); !home.empty()) {
    std::filesystem::path personal = std::filesystem::path(home) / ".config/kenaf/kenaf.toml";
    if (std::filesystem::exists(personal, ignored)) return personal;
  }
  return {};
}

}  // namespace

std::vector<std::string> config_keys() {
  std::vector<std::string> keys;
  for (const NumberKey& key : kNumberKeys) keys.emplace_back(key.name);
  for (const FlagKey& key : kFlagKeys) keys.emplace_back(key.name);
  for (const TextKey& key : kTextKeys) keys.emplace_back(key.name);
  return keys;
}

hrt_config default_config() {
  hrt_config config{};
  config.size = sizeof config;
  config.cookie = kCookie;
  for (const NumberKey& key : kNumberKeys) config.*key.member = key.standard;
  for (const FlagKey& key : kFlagKeys) config.*key.member = 1;
  std::strcpy(config.relay, "127.0.0.1:45454");
  std::strcpy(config.robot, "kenaf");
  std::strcpy(config.camera_server, "127.0.0.1:5003");
  return config;
}

hrt_config whole_config(const hrt_config& config) {
  hrt_config whole = default_config();
  if (config.size < kFirstConfigSize || config.size > sizeof whole || config.cookie != kCookie) {
    throw Error(HRT_E_ARGUMENT, "hrt_config: it was not made by hrt_config_default()");
  }
  std::memcpy(&whole, &config, config.size);
  whole.size = sizeof whole;
  return whole;
}

void apply_toml(std::string_view text, const std::string& name_for_errors, hrt_config& config) {
  const auto fail = [&](const toml::source_position& where, std::string_view what) {
    throw Error(HRT_E_CONFIG, fmt::format("{}:{}:{}: {}", name_for_errors, where.line, where.column, what));
  };
  toml::table table;
  try {
    table = toml::parse(text, name_for_errors);
  } catch (const toml::parse_error& error) {
    fail(error.source().begin, error.description());
  }
  hrt_config changed = config;
  for (const auto& [key, node] : table) {
    // A wrong value is reported at its own position, an unknown key at its name.
    const std::string wrong = set_from_toml(key.str(), node, changed);
    if (!wrong.empty()) fail(wrong.starts_with("unknown") ? key.source().begin : node.source().begin, wrong);
  }
  config = changed;
}

void apply_environment(const Environment& environment, hrt_config& config) {
  // `changed` is a copy: a wrong variable leaves `config` as it was.
  hrt_config changed = config;
  const auto value_of = [&](const char* key) -> std::optional<std::string_view> {
    const auto found = environment.find(variable_name(key));
    return found == environment.end() ? std::nullopt : std::optional<std::string_view>(found->second);
  };
  const auto check = [](const char* key, const std::string& wrong) {
    if (!wrong.empty())
      throw Error(HRT_E_CONFIG, fmt::format("environment variable {}: {}", variable_name(key), wrong));
  };

  if (const std::string wrong = settings::wrong_variable(environment); !wrong.empty()) throw Error(HRT_E_CONFIG, wrong);

  // Each key by the type of its member; variables that are not set change nothing.
  for (const NumberKey& key : kNumberKeys) {
    if (const auto text = value_of(key.name)) {
      const std::optional<double> value = settings::number_from(*text);
      check(key.name, value ? set_number(key, *value, changed)
                            : fmt::format("'{}' is not a number; {} must be from {} to {}", *text, key.name,
                                          key.minimum, key.maximum));
    }
  }
  for (const FlagKey& key : kFlagKeys) {
    if (const auto text = value_of(key.name)) {
      const std::optional<bool> value = flag_from(*text);
      check(key.name, value ? "" : fmt::format("'{}' is neither true nor false, 1 nor 0", *text));
      changed.*key.member = *value ? 1 : 0;
    }
  }
  for (const TextKey& key : kTextKeys) {
    if (const auto text = value_of(key.name)) check(key.name, set_text(key, *text, changed));
  }
  config = changed;
}

void load_config(const Environment& environment, hrt_config& config) {
  hrt_config changed = config;
  if (const std::filesystem::path path = file_that_applies(environment); !path.empty()) {
    std::ifstream file(path);
    file.peek();  // reading a directory sets badbit here and would throw below
    std::string text;
    if (file.good()) text.assign(std::istreambuf_iterator<char>(file), {});
    if (!file.is_open() || file.bad()) {
      throw Error(HRT_E_CONFIG, fmt::format("{}: cannot be read: {}; KENAF_CONFIG names the configuration file",
                                            path.string(), std::strerror(errno)));
    }
    apply_toml(text, path.string(), changed);
  }
  apply_environment(environment, changed);
  check_together(changed, HRT_E_CONFIG);
  config = changed;
}

void check_config(const hrt_config& config) {
  const auto check = [](const std::string& wrong) {
    if (!wrong.empty()) throw Error(HRT_E_ARGUMENT, "hrt_config: " + wrong);
  };
  hrt_config copy = config;
  for (const NumberKey& key : kNumberKeys) check(set_number(key, config.*key.member, copy));
  for (const TextKey& key : kTextKeys) {
    const std::span<char> text = key.member(copy);
    const auto end = std::ranges::find(text, '\0');
    if (end == text.end()) check(fmt::format("{} has no terminating zero", key.name));
    check(end == text.begin() && !key.may_be_empty ? fmt::format("{} must not be empty", key.name) : "");
  }
}

void check_together(const hrt_config& config, int code) {
  // the time since the last call is checked once a cycle: such a robot would be stopped in every cycle
  if (config.period_s > config.command_timeout_s) {
    throw Error(
        code, fmt::format("period_s, {}, must not be above command_timeout_s, {}: the tracks would stop in every cycle",
                          config.period_s, config.command_timeout_s));
  }
}

}  // namespace kenaf::hrt
