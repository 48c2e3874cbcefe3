// The configuration file's parser: any text gives either a valid configuration or an error with a place; never both.
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string_view>

#include "hrt/config.hpp"
#include "hrt/error.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  hrt_config config = kenaf::hrt::default_config();
  const hrt_config before = config;
  try {
    kenaf::hrt::apply_toml(text, "fuzz.toml", config);
  } catch (const kenaf::hrt::Error& error) {
    const bool has_place = std::string_view(error.what()).starts_with("fuzz.toml:");
    if (error.code() != HRT_E_CONFIG || !has_place || std::memcmp(&config, &before, sizeof config) != 0) std::abort();
    return 0;
  }
  kenaf::hrt::check_config(config);  // throws, and so ends the fuzzer, where the parser let something through
  return 0;
}
