// The robot's pose as motion capture or lidar reports it, without noise: the effects tracking_*, tracked_point_* and
// clock_offset.
//
// Thread safety: values and pure functions.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "physics/effects.hpp"

namespace kenaf::rollout {

struct TrackedPose {
  Eigen::Vector3d p_WB_m;
  double yaw_rad;
};

// True poses in the order of time; not empty.
struct PoseCourse {
  std::vector<double> t_s;
  std::vector<TrackedPose> pose;
  // The robot's motion before the first pose, which is steady.
  Eigen::Vector3d v_WB_mps{0, 0, 0};
  double yaw_radps = 0;

  // Interpolated linearly, yaw the short way; after the last pose the robot stands.
  TrackedPose at(double time_s) const;
};

// How late the pose is reported; below 0 early, by a clock that is ahead.
double late_s(const physics::Effects& effects);

// Returns the poses that are reported at `row_s`. The effects act in the order delay and clock, point, turn, scale; the
// point's offset is turned by yaw alone, without roll, pitch and z. A clock that is ahead needs poses after the last
// row. With neutral effects returns the true poses, to the last bit.
//
// `first_report`: of the run that is replayed, if one is: reports that would begin elsewhere, as they are late or
// early, are moved in the plane so that they begin there, as those of the real robot did.
std::vector<TrackedPose> reported_poses(const PoseCourse& course, std::span<const double> row_s,
                                        const physics::Effects& effects,
                                        const std::optional<TrackedPose>& first_report);

}  // namespace kenaf::rollout
