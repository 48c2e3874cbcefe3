#include "rollout/tracking.hpp"

#include <algorithm>
#include <cmath>

#include "robot/angles.hpp"

namespace kenaf::rollout {
namespace {

Eigen::Vector2d turned(const Eigen::Vector2d& v, double angle_rad) {
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  return {c * v.x() - s * v.y(), s * v.x() + c * v.y()};
}

// A pose in the plane as seen from `from`, put down at `to`.
TrackedPose moved(const TrackedPose& pose, const TrackedPose& from, const TrackedPose& to) {
  const double turn_rad = to.yaw_rad - from.yaw_rad;
  TrackedPose result = pose;
  result.p_WB_m.head<2>() = to.p_WB_m.head<2>() + turned((pose.p_WB_m - from.p_WB_m).head<2>(), turn_rad);
  result.yaw_rad += turn_rad;
  return result;
}

// Of the robot that started at `start`, whose pose is now `pose`.
TrackedPose reported(TrackedPose pose, const TrackedPose& start, const physics::Effects& effects) {
  // The start is where the point was reported, so only its motion since then counts: (R(yaw) - R(yaw_0)) p_BP.
  const Eigen::Vector2d p_BP_m(effects.tracked_point_forward_m, effects.tracked_point_left_m);
  if (!p_BP_m.isZero(0)) pose.p_WB_m.head<2>() += turned(p_BP_m, pose.yaw_rad) - turned(p_BP_m, start.yaw_rad);
  // The run started at the reported heading, to the left of the true one by the turn, so the reported path is turned
  // to the right by that angle about the start.
  if (effects.tracking_turn_rad != 0)
    pose.p_WB_m.head<2>() =
        start.p_WB_m.head<2>() + turned((pose.p_WB_m - start.p_WB_m).head<2>(), -effects.tracking_turn_rad);
  if (effects.tracking_scale != 1)
    for (const Eigen::Index axis : {0, 1})
      pose.p_WB_m[axis] = start.p_WB_m[axis] + effects.tracking_scale * (pose.p_WB_m[axis] - start.p_WB_m[axis]);
  return pose;
}

}  // namespace

TrackedPose PoseCourse::at(double time_s) const {
  const auto next = static_cast<std::size_t>(std::ranges::upper_bound(t_s, time_s) - t_s.begin());
  if (next == t_s.size()) return pose.back();
  if (next == 0) {
    const double before_s = t_s.front() - time_s;
    return {pose.front().p_WB_m - before_s * v_WB_mps, pose.front().yaw_rad - before_s * yaw_radps};
  }
  const TrackedPose &from = pose[next - 1], &to = pose[next];
  const double share = (time_s - t_s[next - 1]) / (t_s[next] - t_s[next - 1]);
  return {from.p_WB_m + share * (to.p_WB_m - from.p_WB_m),
          from.yaw_rad + share * robot::wrap_angle(to.yaw_rad - from.yaw_rad)};
}

double late_s(const physics::Effects& effects) {
  return effects.tracking_delay_s + effects.clock_offset_s;
}

std::vector<TrackedPose> reported_poses(const PoseCourse& course, std::span<const double> row_s,
                                        const physics::Effects& effects,
                                        const std::optional<TrackedPose>& first_report) {
  const double late = late_s(effects);
  const TrackedPose first = course.at(row_s.front() - late);
  TrackedPose start = course.pose.front();
  const bool is_moved = first_report && (first.p_WB_m != start.p_WB_m || first.yaw_rad != start.yaw_rad);
  if (is_moved) start = *first_report;
  std::vector<TrackedPose> poses;
  poses.reserve(row_s.size());
  for (const double t_s : row_s) {
    const TrackedPose pose = course.at(t_s - late);
    poses.push_back(reported(is_moved ? moved(pose, first, start) : pose, start, effects));
  }
  return poses;
}

}  // namespace kenaf::rollout
