// What motion capture or lidar makes of the robot's pose before noise: the effects tracking_delay and tracking_scale.
// Thread safety: none; one thread owns a Tracking.
#pragma once

#include <Eigen/Core>
#include <deque>

#include "physics/effects.hpp"

namespace kenaf::rollout {

struct TrackedPose {
  Eigen::Vector3d p_WB_m;
  double yaw_rad;
};

class Tracking {
 public:
  explicit Tracking(const physics::Effects& effects)
      : delay_s_(effects.tracking_delay_s), scale_(effects.tracking_scale) {}

  // The pose that is reported when the true one is `pose`; the first call's is the start. Times rise. At neutral effects the
  // true pose, to the last bit.
  TrackedPose report(double t_s, const TrackedPose& pose);

 private:
  struct Sample {
    double t_s;
    TrackedPose pose;
  };
  TrackedPose pose_at(double t_s);

  double delay_s_, scale_;
  Eigen::Vector3d origin_m_{0, 0, 0};
  std::deque<Sample> past_;  // from the last one that is older than the delay on
  bool started_ = false;
};

}  // namespace kenaf::rollout
