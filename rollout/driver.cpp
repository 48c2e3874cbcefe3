#include "rollout/driver.hpp"

#include <cmath>
#include <limits>

#include "robot/angles.hpp"

namespace kenaf::rollout {
namespace {

bool holds(const GiveUp& give_up, const physics::Pose& X_WB) {
  return !(give_up.x_below_m && X_WB.p.x() >= *give_up.x_below_m) &&
         !(give_up.pitch_below_rad && physics::roll_pitch_yaw(X_WB.q).y() >= *give_up.pitch_below_rad);
}

}  // namespace

Driver::Driver(const Manoeuvre& manoeuvre, const std::array<double, robot::kFlipperCount>& flipper_rad)
    : manoeuvre_(manoeuvre) {
  for (std::size_t i = 0; i < flipper_rad.size(); ++i) command_.flipper[i] = {robot::JointMode::angle, flipper_rad[i]};
}

bool Driver::ended(const Phase& phase, double t_s, const physics::Pose& X_WB) const {
  const PhaseEnd& end = phase.end;
  const double pitch_rad = physics::roll_pitch_yaw(X_WB.q).y();
  return t_s - phase_began_s_ >= phase.at_most_s - runs::kSameTime_s ||
         (end.pitch_above_rad && pitch_rad > *end.pitch_above_rad) ||
         (end.pitch_below_rad && pitch_rad < *end.pitch_below_rad) || (end.x_above_m && X_WB.p.x() > *end.x_above_m) ||
         (end.x_below_m && X_WB.p.x() < *end.x_below_m) || (end.z_above_m && X_WB.p.z() > *end.z_above_m) ||
         (end.turned_rad && std::abs(turned_rad_) >= *end.turned_rad);
}

std::size_t Driver::next_phase(const physics::Pose& X_WB) {
  const std::size_t next = phase_ + 1, last = manoeuvre_.phases.size() - 1;
  if (next >= last) return next;
  const std::optional<GiveUp>& give_up = manoeuvre_.phases[next].give_up;
  if (!give_up || !holds(*give_up, X_WB)) return next;
  gave_up_ = true;
  return last;
}

std::optional<robot::Command> Driver::command(double t_s, const physics::Pose& X_WB) {
  if (!manoeuvre_.timed.empty()) return timed_command(t_s);

  // The turn since the phase began, through full turns; phases that end here follow each other at once.
  const double yaw_rad = physics::roll_pitch_yaw(X_WB.q).z();
  if (last_yaw_rad_) turned_rad_ += robot::wrap_angle(yaw_rad - *last_yaw_rad_);
  last_yaw_rad_ = yaw_rad;
  while (phase_ < manoeuvre_.phases.size() && ended(manoeuvre_.phases[phase_], t_s, X_WB)) {
    phase_ = next_phase(X_WB);
    phase_began_s_ = t_s;
    turned_rad_ = 0;
  }
  if (phase_ == manoeuvre_.phases.size()) return std::nullopt;

  // The phase's command; flippers that it does not state stay as before.
  const Phase& phase = manoeuvre_.phases[phase_];
  command_.track_speed_mps = phase.track_mps;
  for (std::size_t i = 0; phase.flipper_rad && i < command_.flipper.size(); ++i)
    command_.flipper[i].value = (*phase.flipper_rad)[i];
  return command_;
}

void Driver::obey(const robot::Command& command) {
  command_.track_speed_mps = command.track_speed_mps;
  for (std::size_t i = 0; i < command.flipper.size(); ++i)
    if (command.flipper[i].mode != robot::JointMode::keep) command_.flipper[i] = command.flipper[i];
}

std::optional<robot::Command> Driver::timed_command(double t_s) {
  const std::vector<TimedCommand>& timed = manoeuvre_.timed;
  while (next_timed_ < timed.size() && timed[next_timed_].t_s <= t_s + runs::kSameTime_s)
    obey(timed[next_timed_++].command);
  if (next_timed_ == timed.size()) return std::nullopt;
  return command_;
}

double Driver::next_due_s() const {
  return next_timed_ < manoeuvre_.timed.size() ? manoeuvre_.timed[next_timed_].t_s - runs::kSameTime_s
                                               : std::numeric_limits<double>::infinity();
}

bool succeeded(const Manoeuvre& manoeuvre, const physics::Pose& X_WB) {
  if (!manoeuvre.success) return false;
  const Success& success = *manoeuvre.success;
  const Eigen::Vector3d rpy = physics::roll_pitch_yaw(X_WB.q);
  return X_WB.p.allFinite() && !(success.x_above_m && X_WB.p.x() <= *success.x_above_m) &&
         !(success.z_above_m && X_WB.p.z() <= *success.z_above_m) &&
         !(success.z_below_m && X_WB.p.z() >= *success.z_below_m) && std::abs(rpy.x()) <= success.upright_within_rad &&
         std::abs(rpy.y()) <= success.upright_within_rad;
}

}  // namespace kenaf::rollout
