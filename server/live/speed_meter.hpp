// Measures how fast robot time passes, over the last second. Thread safety: a value.
#pragma once

#include <deque>

namespace kenaf::live {

class SpeedMeter {
 public:
  static constexpr double kWindow_s = 1;

  // Returns robot time per wall-clock time, up to this reading; 0 before the second one. Restarts if robot time goes
  // back.
  double read(double wall_s, double time_s) {
    if (!readings_.empty() && time_s < readings_.back().time_s) readings_.clear();
    readings_.push_back({wall_s, time_s});
    while (readings_.size() > 2 && wall_s - readings_[1].wall_s >= kWindow_s) readings_.pop_front();
    const double passed_s = wall_s - readings_.front().wall_s;
    return passed_s > 0 ? (time_s - readings_.front().time_s) / passed_s : 0;
  }

 private:
  struct Reading {
    double wall_s, time_s;
  };
  std::deque<Reading> readings_;
};

}  // namespace kenaf::live
