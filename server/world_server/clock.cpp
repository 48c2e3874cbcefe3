#include "server/world_server/clock.hpp"

#include <algorithm>

namespace kenaf::world_server {

Clock::Clock(double time_step_s, double speed) : time_step_s_(time_step_s), speed_(speed) {}

void Clock::set_speed(double speed) {
  speed_ = speed;
  owed_s_ = 0;
}

double Clock::pass(double wall_s) {
  const double passed_s = started_ ? std::max(0.0, wall_s - wall_s_) : 0;
  skip(wall_s);
  if (paused_) owed_s_ = 0;
  if (paused_ || speed_ == 0) return 0;
  owed_s_ += passed_s * speed_;
  const double most_s = std::max(kCatchUp_s * speed_, 2 * time_step_s_);
  const double dropped_s = std::max(0.0, owed_s_ - most_s);
  owed_s_ -= dropped_s;
  return dropped_s;
}

void Clock::skip(double wall_s) {
  started_ = true;
  wall_s_ = wall_s;
}

// A millionth of a step is tolerated: the sum of many short waits is not exactly their total.
bool Clock::step_due() const {
  return !paused_ && (speed_ == 0 || owed_s_ >= time_step_s_ * (1 - 1e-6));
}

void Clock::stepped() {
  if (!paused_ && speed_ > 0) owed_s_ -= time_step_s_;
}

double Clock::step_wall_s(std::uint64_t count) const {
  return speed_ == 0 ? wall_s_ : wall_s_ + std::max(0.0, static_cast<double>(count) * time_step_s_ - owed_s_) / speed_;
}

}  // namespace kenaf::world_server
