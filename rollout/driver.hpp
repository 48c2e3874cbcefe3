// The operator of a manoeuvre: from posture, place and time to the next command.
//
// Knows no simulator; the same operator could watch a robot. Thread safety: a value.
#pragma once

#include <optional>

#include "physics/pose.hpp"
#include "robot/command.hpp"
#include "rollout/manoeuvre.hpp"

namespace kenaf::rollout {

class Driver {
 public:
  // `manoeuvre` must outlive this. `flipper_rad`: where the flippers are at the start.
  Driver(const Manoeuvre& manoeuvre, const std::array<double, robot::kFlipperCount>& flipper_rad);

  // What to command from `t_s` on, which never goes back; empty: the manoeuvre is over, the command before holds. A
  // phase ends at the first call at which its end holds, and the next one begins with it, or the last one where
  // the next one is given up.
  std::optional<robot::Command> command(double t_s, const physics::Pose& X_WB);

  // When a replay's next command is due; infinity otherwise: phases are as quick as they are asked.
  double next_due_s() const;
  // Of the phase that runs now; as many as there are when the manoeuvre is over.
  std::size_t phase() const { return phase_; }
  // Whether a phase was given up.
  bool gave_up() const { return gave_up_; }

 private:
  bool ended(const Phase& phase, double t_s, const physics::Pose& X_WB) const;
  std::size_t next_phase(const physics::Pose& X_WB);
  std::optional<robot::Command> timed_command(double t_s);

  const Manoeuvre& manoeuvre_;
  robot::Command command_;
  std::size_t phase_ = 0, next_timed_ = 0;
  bool gave_up_ = false;
  double phase_began_s_ = 0, turned_rad_ = 0;
  std::optional<double> last_yaw_rad_;
};

// Whether the manoeuvre's own measure is met with the robot at `X_WB`; false without one.
bool succeeded(const Manoeuvre& manoeuvre, const physics::Pose& X_WB);

}  // namespace kenaf::rollout
