// The pace of robot time: a factor of wall-clock time, as fast as possible, or stopped.
//
// Pure: wall-clock time comes in as an argument, in seconds of any steady clock. Thread safety: a value.
#pragma once

#include <cstdint>

namespace kenaf::world_server {

class Clock {
 public:
  // Wall-clock time that is caught up after a delay; older time is dropped, so that a slow machine falls behind instead
  // of stepping in ever longer bursts.
  static constexpr double kCatchUp_s = 0.1;

  // `speed` times real time; 0 = as fast as possible.
  Clock(double time_step_s, double speed);

  double speed() const { return speed_; }
  void set_speed(double speed);
  bool paused() const { return paused_; }
  void set_paused(bool paused) { paused_ = paused; }

  // Lets wall-clock time pass. Returns the robot time dropped, 0 if the simulation keeps up.
  double pass(double wall_s);
  // Lets wall-clock time pass without robot time, because nobody needs it.
  void skip(double wall_s);
  bool step_due() const;
  void stepped();
  // Time of the `count`-th step from now, from 1 on, if none is due now and the clock is not paused.
  double step_wall_s(std::uint64_t count) const;

 private:
  double time_step_s_;
  double speed_;
  bool paused_ = false;
  bool started_ = false;
  double wall_s_ = 0;
  double owed_s_ = 0;  // robot time that may pass
};

}  // namespace kenaf::world_server
