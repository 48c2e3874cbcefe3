#include "server/world_server/frame_schedule.hpp"

namespace kenaf::world_server {

void FrameSchedule::start(std::uint64_t step, std::uint64_t period_steps, bool numbered) {
  const bool lockstep = lockstep_;
  *this = FrameSchedule();
  lockstep_ = lockstep;
  period_steps_ = period_steps;
  next_step_ = step;
  numbered_ = numbered;
}

void FrameSchedule::restart_at(std::uint64_t step) {
  next_step_ = step;
  answered_ = true;
  holds_since_wall_s_.reset();
}

void FrameSchedule::set_lockstep(bool lockstep) {
  lockstep_ = lockstep;
  let_go_ = false;
  holds_since_wall_s_.reset();
}

void FrameSchedule::begin_frame(std::uint64_t step) {
  ++frame_;
  answered_ = false;
  next_step_ = step + period_steps_;
  holds_since_wall_s_.reset();
}

FrameSchedule::Answer FrameSchedule::take_answer(std::uint64_t frame, bool ends_answer) {
  if (frame > frame_) return Answer::ahead;
  if (frame < frame_) {
    if (ends_answer) ++late_;
    return Answer::late;
  }
  if (ends_answer) {
    answered_ = true;
    let_go_ = false;
  }
  return Answer::in_time;
}

bool FrameSchedule::holds(std::uint64_t step) const {
  return numbered_ && lockstep_ && !answered_ && !let_go_ && step >= next_step_;
}

bool FrameSchedule::let_go(double wall_s, double longest_wait_s) {
  if (!holds_since_wall_s_) holds_since_wall_s_ = wall_s;
  if (wall_s < *holds_since_wall_s_ + longest_wait_s) return false;
  let_go_ = true;
  holds_since_wall_s_.reset();
  return true;
}

}  // namespace kenaf::world_server
