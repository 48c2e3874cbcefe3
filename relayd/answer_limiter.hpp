// Prevents reflection attacks through the relay: a forged sender of a small datagram would be sent a large answer.
//
// Thread safety: a value.
#pragma once

#include <algorithm>
#include <chrono>
#include <optional>

namespace kenaf::relayd {

class AnswerLimiter {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  static constexpr double kAnswersPerSecond = 100;  // also the burst allowed after a quiet second

  // Returns whether one more answer may be sent.
  bool allow(TimePoint now) {
    const std::chrono::duration<double> passed = last_ ? now - *last_ : std::chrono::seconds(0);
    last_ = now;
    left_ = std::min(kAnswersPerSecond, left_ + passed.count() * kAnswersPerSecond);
    if (left_ < 1) return false;
    left_ -= 1;
    return true;
  }

 private:
  std::optional<TimePoint> last_;
  double left_ = kAnswersPerSecond;
};

}  // namespace kenaf::relayd
