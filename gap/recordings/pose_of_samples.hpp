// The poses of a body out of the numbers of a recording.
//
// Thread safety: pure functions.
#pragma once

#include <Eigen/Geometry>
#include <span>
#include <string>
#include <vector>

#include "gap/logs/merge_pose.hpp"
#include "gap/recordings/mapping.hpp"
#include "gap/recordings/samples.hpp"

namespace kenaf::gap::recordings {

// The rotation that `numbers` say in `order` (PoseMapping::order): a quaternion x, y, z, w, which is normed; axis times
// angle; or angles about the named axes, each as turned by the ones before. Angles in rad.
Eigen::Quaterniond rotation_of(const std::string& order, std::span<const double> numbers);

struct PoseOfSamples {
  logs::MotionCapture capture;  // z up; times as of the samples
  std::vector<std::string> remarks;
};

// Poses where all numbers have a value at one time. Quaternions whose norm differs from 1 by more than 0.01 are left
// out and counted. Throws RecordingError if fewer than two poses are left, or an axis other than z points up and z or
// the tilt is missing.
PoseOfSamples pose_of_samples(const PoseMapping& mapping, const Collected& collected);

}  // namespace kenaf::gap::recordings
