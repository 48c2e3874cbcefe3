// The operator of a manoeuvre: from posture, position and time to the next command.
//
// Independent of any simulator: it could drive a real robot too. Thread safety: a value.
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

  // Returns the command from `t_s` on, which must not decrease; empty if the manoeuvre is over, and the last command
  // holds. A phase ends at the first call at which its end condition holds; then the next one begins. If that one
  // is to be given up at that moment (Phase::give_up), the manoeuvre's last phase begins instead.
  std::optional<robot::Command> command(double t_s, const physics::Pose& X_WB);

  // When a replay's next command is due; infinity for phases, which react at each call.
  double next_due_s() const;
  // Index of the present phase; their number when the manoeuvre is over.
  std::size_t phase() const { return phase_; }
  // Whether a phase was given up.
  bool gave_up() const { return gave_up_; }

 private:
  bool ended(const Phase& phase, double t_s, const physics::Pose& X_WB) const;
  std::size_t next_phase(const physics::Pose& X_WB);
  void obey(const robot::Command& command);
  std::optional<robot::Command> timed_command(double t_s);

  const Manoeuvre& manoeuvre_;
  robot::Command command_;
  std::size_t phase_ = 0, next_timed_ = 0;
  bool gave_up_ = false;
  double phase_began_s_ = 0, turned_rad_ = 0;
  std::optional<double> last_yaw_rad_;
};

// Whether the robot at `X_WB` meets the manoeuvre's success criterion; false without one.
bool succeeded(const Manoeuvre& manoeuvre, const physics::Pose& X_WB);

}  // namespace kenaf::rollout
