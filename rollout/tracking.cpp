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

}  // namespace

Tracking::Tracking(const physics::Effects& effects)
    : delay_s_(effects.tracking_delay_s),
      p_BP_m_(effects.tracked_point_forward_m, effects.tracked_point_left_m),
      turn_rad_(effects.tracking_turn_rad),
      scale_(effects.tracking_scale) {}

TrackedPose Tracking::report(double t_s, const TrackedPose& pose) {
  if (!started_) start_ = pose;
  started_ = true;
  TrackedPose reported = pose;
  if (delay_s_ > 0) {
    past_.push_back({t_s, pose});
    reported = pose_at(t_s - delay_s_);
  }
  // The start is where the point was reported, so only its motion since then counts: (R(yaw) - R(yaw_0)) p_BP.
  if (!p_BP_m_.isZero(0))
    reported.p_WB_m.head<2>() += turned(p_BP_m_, reported.yaw_rad) - turned(p_BP_m_, start_.yaw_rad);
  // The run started at the reported heading, to the left of the true one by turn_rad_, so the reported path is turned
  // to the right by that angle about the start.
  if (turn_rad_ != 0)
    reported.p_WB_m.head<2>() =
        start_.p_WB_m.head<2>() + turned((reported.p_WB_m - start_.p_WB_m).head<2>(), -turn_rad_);
  if (scale_ != 1)
    for (const Eigen::Index axis : {0, 1})
      reported.p_WB_m[axis] = start_.p_WB_m[axis] + scale_ * (reported.p_WB_m[axis] - start_.p_WB_m[axis]);
  return reported;
}

TrackedPose Tracking::pose_at(double t_s) {
  while (past_.size() > 1 && past_[1].t_s <= t_s) past_.pop_front();
  const Sample& before = past_.front();
  if (t_s <= before.t_s) return before.pose;
  const Sample& after = past_[1];  // there is one: the newest sample is later than t_s
  const double share = (t_s - before.t_s) / (after.t_s - before.t_s);
  return {before.pose.p_WB_m + share * (after.pose.p_WB_m - before.pose.p_WB_m),
          before.pose.yaw_rad + share * robot::wrap_angle(after.pose.yaw_rad - before.pose.yaw_rad)};
}

std::vector<double> delayed(std::span<const double> t_s, std::span<const double> values, double late_s, bool angles) {
  std::vector<double> out;
  out.reserve(values.size());
  for (const double t : t_s) {
    const auto next = static_cast<std::size_t>(std::ranges::upper_bound(t_s, t - late_s) - t_s.begin());
    if (next == 0 || next == t_s.size()) {
      out.push_back(next == 0 ? values.front() : values.back());
      continue;
    }
    const double share = (t - late_s - t_s[next - 1]) / (t_s[next] - t_s[next - 1]);
    const double step = values[next] - values[next - 1];
    out.push_back(values[next - 1] + share * (angles ? robot::wrap_angle(step) : step));
  }
  return out;
}

}  // namespace kenaf::rollout
