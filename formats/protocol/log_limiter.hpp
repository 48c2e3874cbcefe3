// Keeps a hostile or broken peer from filling the disk by way of the log: of one kind of line `burst` may be written at
// once, and one more for each `interval` that has passed; the others are counted.
//
// Times are of a steady clock, from any origin, as time points or in seconds; one object is always given the same
// clock. The first line is always written. A time before that of the last call counts as the same moment.
//
// Thread safety: a value; one for each kind of line and thread. Nothing allocates.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <optional>
#include <utility>

namespace kenaf::protocol {

class LogLimiter {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  // `burst` lines, at least 1; `interval_s` above 0.
  explicit LogLimiter(double burst = 1, double interval_s = 1)
      : interval_(nanoseconds_of(interval_s)), full_(nanoseconds_of(burst * interval_s)), saved_(full_) {}

  // nullopt: suppress the line. Otherwise write it; the number says how many were suppressed since the last written
  // one.
  std::optional<std::uint64_t> allow(TimePoint now = std::chrono::steady_clock::now()) {
    if (last_) saved_ = std::min(full_, saved_ + std::max(now - *last_, Duration::zero()));
    last_ = std::max(now, last_.value_or(now));
    if (saved_ < interval_) {
      ++suppressed_;
      return std::nullopt;
    }
    saved_ -= interval_;
    return std::exchange(suppressed_, 0);
  }
  std::optional<std::uint64_t> allow(double now_s) { return allow(TimePoint(nanoseconds_of(now_s))); }

 private:
  using Duration = std::chrono::nanoseconds;  // whole numbers: a line exactly one interval later is written
  static Duration nanoseconds_of(double seconds) {
    return std::chrono::round<Duration>(std::chrono::duration<double>(seconds));
  }

  Duration interval_, full_;
  Duration saved_;  // time that lines may still use up, `interval_` each
  std::optional<TimePoint> last_;
  std::uint64_t suppressed_ = 0;
};

}  // namespace kenaf::protocol
