#include "rollout/tracking.hpp"

#include "protocol/frames.hpp"

namespace kenaf::rollout {

TrackedPose Tracking::report(double t_s, const TrackedPose& pose) {
  if (!started_) origin_m_ = pose.p_WB_m;
  started_ = true;
  TrackedPose reported = pose;
  if (delay_s_ > 0) {
    past_.push_back({t_s, pose});
    reported = pose_at(t_s - delay_s_);
  }
  if (scale_ != 1)
    for (const Eigen::Index axis : {0, 1})
      reported.p_WB_m[axis] = origin_m_[axis] + scale_ * (reported.p_WB_m[axis] - origin_m_[axis]);
  return reported;
}

TrackedPose Tracking::pose_at(double t_s) {
  while (past_.size() > 1 && past_[1].t_s <= t_s) past_.pop_front();
  const Sample& before = past_.front();
  if (t_s <= before.t_s) return before.pose;
  const Sample& after = past_[1];  // there is one: the newest sample is later than t_s
  const double share = (t_s - before.t_s) / (after.t_s - before.t_s);
  return {before.pose.p_WB_m + share * (after.pose.p_WB_m - before.pose.p_WB_m),
          before.pose.yaw_rad + share * frames::wrap_angle(after.pose.yaw_rad - before.pose.yaw_rad)};
}

}  // namespace kenaf::rollout
