// How long tests wait for what must happen. The limit is for hangs alone: no machine is so slow that it is reached.
#pragma once

#include <charconv>
#include <chrono>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>

namespace kenaf::support {

// "60": a whole number of seconds, from 1 to a day. Throws std::invalid_argument.
inline std::chrono::seconds patience_from(std::string_view text) {
  int seconds = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seconds);
  if (error != std::errc{} || end != text.data() + text.size() || seconds < 1 || seconds > 86400)
    throw std::invalid_argument("environment variable KENAF_PATIENCE_S=" + std::string(text) +
                                ": must be a whole number of seconds from 1 to 86400");
  return std::chrono::seconds(seconds);
}

// $KENAF_PATIENCE_S, or ten minutes. ctest's own limit for a test (--timeout) is longer. Throws as patience_from().
inline std::chrono::seconds patience() {
  const char* set = std::getenv("KENAF_PATIENCE_S");
  return set != nullptr ? patience_from(set) : std::chrono::seconds(600);
}

// Returns whether `condition` held in time. It is asked again and again.
template <class Condition>
bool eventually(const Condition& condition) {
  const auto end = std::chrono::steady_clock::now() + patience();
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

}  // namespace kenaf::support
