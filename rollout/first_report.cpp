#include "rollout/first_report.hpp"

#include <algorithm>

namespace kenaf::rollout {
namespace {

using physics::Pose;

Pose in_the_plane(double x_m, double y_m, double yaw_rad) {
  return {{x_m, y_m, 0}, physics::rotation_from({0, 0, yaw_rad})};
}

Pose in_the_plane(const Pose& X) {
  return in_the_plane(X.p.x(), X.p.y(), physics::roll_pitch_yaw(X.q).z());
}

// The first part of a replay.
Manoeuvre until(Manoeuvre manoeuvre, double end_s) {
  std::vector<TimedCommand>& timed = manoeuvre.timed;
  if (timed.back().t_s <= end_s) return manoeuvre;
  std::erase_if(timed, [&](const TimedCommand& command) { return command.t_s >= end_s; });
  timed.push_back({end_s, timed.back().command});
  return manoeuvre;
}

}  // namespace

bool starts_elsewhere(const physics::Effects& effects, const physics::WorldDescription& world,
                      const Manoeuvre& manoeuvre) {
  const double late = late_s(effects);
  const bool moved_before_or_after = late < 0 || (manoeuvre.start && manoeuvre.start->motion);
  return late != 0 && manoeuvre.start && moved_before_or_after && !(world.boxes.empty() && world.meshes.empty());
}

Pose at_first_report(const physics::RobotDescription& robot, const physics::WorldDescription& world,
                     const Manoeuvre& manoeuvre, const RollOutOptions& options) {
  const double late = late_s(robot.effects);
  if (late > 0) {
    const BodyMotion before = body_motion(robot, *manoeuvre.start->motion);
    return in_the_plane(-late * before.forward_mps, 0, -late * before.yaw_radps);
  }
  physics::RobotDescription prompt = robot;
  prompt.effects.tracking_delay_s = prompt.effects.clock_offset_s = 0;
  const RollOut first = roll_out(prompt, world, until(manoeuvre, -late), options);
  if (!first.fault.empty()) return {};
  const Start& start = *manoeuvre.start;
  return physics::compose(physics::inverse(in_the_plane(start.x_m, start.y_m, start.yaw_rad)),
                          in_the_plane(first.end.X_WB));
}

}  // namespace kenaf::rollout
