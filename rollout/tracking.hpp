// The robot's pose as motion capture or lidar reports it, without noise: the effects tracking_*, tracked_point_* and
// clock_offset. They act in the order delay, point, turn, scale, clock. Before the first pose the robot was where it
// started; the point's offset is turned by yaw alone, without roll, pitch and z; a clock that is ahead repeats the last
// pose at the end.
//
// Thread safety: none; one thread owns a Tracking.
#pragma once

#include <Eigen/Core>
#include <deque>
#include <span>
#include <vector>

#include "physics/effects.hpp"

namespace kenaf::rollout {

struct TrackedPose {
  Eigen::Vector3d p_WB_m;
  double yaw_rad;
};

class Tracking {
 public:
  explicit Tracking(const physics::Effects& effects);

  // Returns the reported pose for the true one; the first call sets the start. Times must increase. With neutral
  // effects returns the true pose, to the last bit. The clock's offset is not included, as it may need later poses: see
  // delayed().
  TrackedPose report(double t_s, const TrackedPose& pose);

 private:
  struct Sample {
    double t_s;
    TrackedPose pose;
  };
  TrackedPose pose_at(double t_s);

  double delay_s_;
  Eigen::Vector2d p_BP_m_;  // the tracked point
  double turn_rad_, scale_;
  TrackedPose start_{{0, 0, 0}, 0};
  std::deque<Sample> past_;  // begins with the newest sample that is older than the delay
  bool started_ = false;
};

// Returns `values` delayed by `late_s`, advanced if that is negative: interpolated linearly, angles the short way;
// beyond the ends, the first and the last value are held. `t_s` must increase.
std::vector<double> delayed(std::span<const double> t_s, std::span<const double> values, double late_s, bool angles);

}  // namespace kenaf::rollout
