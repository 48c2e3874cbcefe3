// Keeps a hostile or broken client from filling the log: a few lines at once, then one per interval.
//
// Thread safety: a value.
#pragma once

#include <algorithm>
#include <cstdint>

namespace kenaf::world_server {

class LogLimiter {
 public:
  explicit LogLimiter(double burst = 1, double interval_s = 5)
      : burst_(burst), interval_s_(interval_s), allowance_(burst) {}

  // True: write the line, and report that `suppressed()` others were not written.
  bool allow(double wall_s) {
    allowance_ = std::min(burst_, allowance_ + std::max(0.0, wall_s - last_wall_s_) / interval_s_);
    last_wall_s_ = wall_s;
    if (allowance_ < 1) {
      ++pending_;
      return false;
    }
    allowance_ -= 1;
    suppressed_ = pending_;
    pending_ = 0;
    return true;
  }
  std::uint64_t suppressed() const { return suppressed_; }

 private:
  double burst_, interval_s_, allowance_;
  double last_wall_s_ = 0;
  std::uint64_t pending_ = 0, suppressed_ = 0;
};

}  // namespace kenaf::world_server
