// Keeps hostile input from filling the disk: at most one line a second of each kind; the others are counted.
//
// Thread safety: one for each kind of line and thread.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <utility>

namespace kenaf::relayd {

class LogLimiter {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  // nullopt: suppress the line. Otherwise write it, and report how many before it were suppressed.
  std::optional<std::uint64_t> allow(TimePoint now = std::chrono::steady_clock::now()) {
    if (last_ && now - *last_ < std::chrono::seconds(1)) {
      ++held_back_;
      return std::nullopt;
    }
    last_ = now;
    return std::exchange(held_back_, 0);
  }

 private:
  std::optional<TimePoint> last_;
  std::uint64_t held_back_ = 0;
};

}  // namespace kenaf::relayd
