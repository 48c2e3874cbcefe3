// How long tests wait for what must happen. The limit is for hangs alone: no machine is so slow that it is reached.
#pragma once

#include <chrono>
#include <cstdlib>
#include <thread>

namespace kenaf::support {

// $KENAF_PATIENCE_S, or ten minutes. ctest's own limit for a test (--timeout) is longer.
inline std::chrono::seconds patience() {
  const char* set = std::getenv("KENAF_PATIENCE_S");
  return std::chrono::seconds(set != nullptr ? std::atoi(set) : 600);
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
