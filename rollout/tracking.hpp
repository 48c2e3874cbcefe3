// What motion capture or lidar makes of the robot's pose before noise: the effects tracking_*, tracked_point_* and
// clock_offset.
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

  // The pose that is reported when the true one is `pose`; the first call's is the start. Times rise. At neutral
  // effects the true pose, to the last bit. The clock's offset is not in it, which may need poses that are still to
  // come: delayed().
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
  std::deque<Sample> past_;  // from the last one that is older than the delay on
  bool started_ = false;
};

// Each value of `values` as it was `late_s` before its time, or will be, if that is below 0: on the straight line
// between two of them; beyond the ends the first and the last one stand. Of angles the line is the short way. `t_s`
// rises.
std::vector<double> delayed(std::span<const double> t_s, std::span<const double> values, double late_s, bool angles);

}  // namespace kenaf::rollout
