// The environment variables of Kenaf. Their names begin with KENAF_, and a name that is not in this list is an error,
// as an unknown key or option is: a misspelt variable would change nothing, and nobody would see it.
#pragma once

#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>

namespace kenaf::settings {

struct Variable {
  enum class Reader {
    library,     // hrt_config_load() and hrt_kenaf_init() of libkenaf_sim and libkenaf_real
    programs,    // the programs and the libraries: where they look for descriptions
    python,      // the package kenaf
    services,    // systemd's units
    development  // tests and scripts of the source tree
  };
  std::string_view name;
  Reader reader;
  std::string_view what;
};

// In the order of the user guide, which has a row for each of those that are not for development. Those of the library
// are KENAF_CONFIG and one for each key of kenaf.toml. Thread safety: constant.
std::span<const Variable> known_variables();

// Names and values.
using Environment = std::map<std::string, std::string, std::less<>>;

// The variables of this process. Thread safety: as getenv(): no other thread may change them meanwhile.
Environment own_environment();

// Returns what is wrong with the variables whose names begin with KENAF_: "environment variable KENAF_RELYA is not
// known; did you mean KENAF_RELAY?", or that KENAF_DATA_DIR names no folder; empty if nothing is. Of several errors the
// first one by name. Values of the library's variables are for the library to check.
std::string wrong_variable(const Environment& environment);

}  // namespace kenaf::settings
