// The configuration: hrt_config of hrt.h, its defaults, TOML file, environment variables and ranges.
//
// Thread safety: pure functions, except load_config, which reads the environment and files.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "formats/settings/environment.hpp"
#include "kenaf/hrt.h"

namespace kenaf::hrt {

hrt_config default_config();

// The first published size: programs compiled then pass a struct that ends here.
inline constexpr std::size_t kFirstConfigSize = offsetof(hrt_config, camera_server);

// Completes the `config` of a program that may have been compiled with an older, shorter struct: missing members get
// their defaults. Reads config.size bytes. Throws Error(HRT_E_ARGUMENT) if it was not made by hrt_config_default().
hrt_config whole_config(const hrt_config& config);

using settings::Environment;

// Overrides `config` from a TOML text. Throws Error(HRT_E_CONFIG) with "name:line:column: what is wrong" and then
// leaves `config` unchanged.
void apply_toml(std::string_view text, const std::string& name_for_errors, hrt_config& config);

// Overrides `config` from KENAF_<KEY> variables. Throws Error(HRT_E_CONFIG) naming the variable, also one whose name
// begins with KENAF_ and is not known (formats/settings/environment.hpp).
void apply_environment(const Environment& environment, hrt_config& config);

// Applies the first file found of $KENAF_CONFIG, ./kenaf.toml and ~/.config/kenaf/kenaf.toml (none is no error), then
// the environment. Throws Error(HRT_E_CONFIG), also if the resulting members contradict each other.
void load_config(const Environment& environment, hrt_config& config);

// Throws Error(HRT_E_ARGUMENT) naming the member that is out of range. `config` must be complete.
void check_config(const hrt_config& config);

// The keys of the file, which are the members of hrt_config that a user may set.
std::vector<std::string> config_keys();

// Throws Error(`code`) naming members that are each in range but contradict each other.
void check_together(const hrt_config& config, int code);

}  // namespace kenaf::hrt
