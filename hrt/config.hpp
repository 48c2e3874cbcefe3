// The configuration: hrt.h's hrt_config, its defaults, its TOML file, its environment variables, its ranges.
//
// Thread safety: pure functions, but for load_config, which reads the environment and files.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

#include "kenaf/hrt.h"

namespace kenaf::hrt {

hrt_config default_config();

// The first published size: a program that was compiled then passes a struct that ends there.
inline constexpr std::size_t kFirstConfigSize = offsetof(hrt_config, camera_server);

// `config` of a program, which may have been compiled with an older and so shorter struct: what it lacks is as by
// default. Reads config.size bytes. Throws Error(HRT_E_ARGUMENT) where it is not from hrt_config_default().
hrt_config whole_config(const hrt_config& config);

// The value of an environment variable, or nullptr.
using Environment = std::function<const char*(const char* name)>;

// Overrides `config` by a TOML text. Throws Error(HRT_E_CONFIG) with "name:line:column: what is wrong"; `config` is
// then unchanged.
void apply_toml(std::string_view text, const std::string& name_for_errors, hrt_config& config);

// Overrides `config` by KENAF_<KEY> variables. Throws Error(HRT_E_CONFIG) naming the variable.
void apply_environment(const Environment& environment, hrt_config& config);

// The file that applies ($KENAF_CONFIG, ./kenaf.toml, ~/.config/kenaf/kenaf.toml; none of them is no error), then the
// environment. Throws Error(HRT_E_CONFIG), also where the members do not go together then.
void load_config(const Environment& environment, hrt_config& config);

// Throws Error(HRT_E_ARGUMENT) naming the member that is out of its range. `config` is a whole one.
void check_config(const hrt_config& config);

// Throws Error(`code`) naming members that are each in their range and do not go together.
void check_together(const hrt_config& config, int code);

}  // namespace kenaf::hrt
