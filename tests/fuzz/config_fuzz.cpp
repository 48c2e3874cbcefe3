// The configuration from a file and from the environment: any text gives either a valid configuration or an error with
// its place; never both. An address in it is HOST:PORT or is refused.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>

#include "formats/protocol/host_port.hpp"
#include "hrt/config.hpp"
#include "hrt/error.hpp"

using namespace kenaf;

namespace {

void check(bool fine) {
  if (!fine) std::abort();
}

bool same(const hrt_config& a, const hrt_config& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

void read_as_file(std::string_view text) {
  hrt_config config = hrt::default_config();
  try {
    hrt::apply_toml(text, "fuzz.toml", config);
  } catch (const hrt::Error& error) {
    check(error.code() == HRT_E_CONFIG && std::string_view(error.what()).starts_with("fuzz.toml:"));
    check(same(config, hrt::default_config()));
    return;
  }
  hrt::check_config(config);  // throws, and so ends the fuzzer, where the parser let something through
}

// Lines of NAME=VALUE.
settings::Environment variables_of(std::string_view text) {
  settings::Environment variables;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    if (const std::size_t equals = line.find('='); equals != line.npos)
      variables.emplace(line.substr(0, equals), line.substr(equals + 1));
  }
  return variables;
}

void read_as_environment(std::string_view text) {
  hrt_config config = hrt::default_config();
  try {
    hrt::apply_environment(variables_of(text), config);
  } catch (const hrt::Error& error) {
    check(error.code() == HRT_E_CONFIG && std::string_view(error.what()).starts_with("environment variable KENAF_"));
    check(same(config, hrt::default_config()));
    return;
  }
  hrt::check_config(config);
  if (const auto relay = protocol::parse_host_port(config.relay)) check(!relay->host.empty());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  read_as_file(text);
  read_as_environment(text);
  return 0;
}
