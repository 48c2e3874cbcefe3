// A path that is understood says no more than its text: a number that the text begins with, and whether its end is
// "/scene".
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "gap/playback/playback_path.hpp"

using namespace kenaf;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto path = gap::playback::parse_playback_path(text);
  if (!path) return 0;
  if (!path->run) {
    if (!text.empty() || path->scene) __builtin_trap();
    return 0;
  }
  std::string digits(text.substr(1, text.size() - 1 - (path->scene ? std::string_view("/scene").size() : 0)));
  digits.erase(0, digits.find_first_not_of('0'));
  if (digits != (*path->run == 0 ? "" : std::to_string(*path->run))) __builtin_trap();
  return 0;
}
