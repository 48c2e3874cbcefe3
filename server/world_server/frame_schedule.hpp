// Output schedule of one connection, and the lock-step barrier: world steps and numbers, no sockets, no world.
// docs/world-server-protocol.md, section Extensions, specifies it. Thread safety: a value.
#pragma once

#include <cstdint>
#include <optional>

namespace kenaf::world_server {

class FrameSchedule {
 public:
  enum class Answer { in_time, late, ahead };  // ahead: for a frame not yet sent

  // First output at once, further ones `period_steps` apart; `numbered` ones are frames 1, 2, 3, ...
  void start(std::uint64_t step, std::uint64_t period_steps, bool numbered);
  // Next output at `step`, while numbers continue: the world was reset to its start.
  void restart_at(std::uint64_t step);
  void set_lockstep(bool lockstep);

  std::uint64_t period_steps() const { return period_steps_; }
  std::uint64_t next_step() const { return next_step_; }  // of the next output, which may have to wait for an answer
  bool numbered() const { return numbered_; }
  bool lockstep() const { return lockstep_; }
  std::uint64_t frame() const { return frame_; }  // the newest one sent, 0 = none yet
  std::uint64_t late() const { return late_; }    // answers that came after their frame

  bool due(std::uint64_t step) const { return step >= next_step_ && !holds(step); }
  // The output is being sent; then the schedule waits for the answer.
  void begin_frame(std::uint64_t step);
  // A command with {Frame n} was received; `ends_answer`: it was a DRIVE.
  Answer take_answer(std::uint64_t frame, bool ends_answer);

  // Lock step: true if the next frame may not begin yet, so that the world may not pass `step`.
  bool holds(std::uint64_t step) const;
  // For a schedule that holds a world ready to step: true after a wait of `longest_wait_s`, after which it lets go.
  bool let_go(double wall_s, double longest_wait_s);
  // Time of the first false result of let_go() in this wait.
  std::optional<double> holds_since_wall_s() const { return holds_since_wall_s_; }

 private:
  std::uint64_t period_steps_ = 1;
  std::uint64_t next_step_ = 0;
  bool numbered_ = false;
  bool lockstep_ = false;
  bool answered_ = true;
  bool let_go_ = false;
  std::uint64_t frame_ = 0;
  std::uint64_t late_ = 0;
  std::optional<double> holds_since_wall_s_;
};

}  // namespace kenaf::world_server
