// A robot's motion in its last steps, for sensors with delays.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "physics/pose.hpp"
#include "robot/parts.hpp"

namespace kenaf::physics {

struct MotionSample {
  double t_s = 0;
  Pose X_WB;
  Eigen::Vector3d v_WB_mps{0, 0, 0}, w_WB_radps{0, 0, 0};
  std::array<double, robot::kTrackCount> track_mps{}, track_m{};  // with the encoders' errors
  std::array<double, robot::kTrackCount> track_a{};
  std::array<double, robot::kFlipperCount> flipper_a{}, servo_rad{};
  double battery_v = 0;
  Eigen::Vector3d odometry{0, 0, 0};  // x, y, yaw from the encoders since add_robot
  std::uint64_t touched = 0;          // bit i: sensor i is touched
};

// The last `length` samples, one a step. No allocation after construction.
class MotionHistory {
 public:
  explicit MotionHistory(std::size_t length) : samples_(std::max<std::size_t>(length, 1)) {}

  void clear() { count_ = 0; }
  void push(const MotionSample& sample) { samples_[count_++ % samples_.size()] = sample; }
  // 0 is the newest; beyond the oldest, returns the oldest.
  const MotionSample& back(std::size_t steps) const {
    const std::size_t kept = std::min(count_, samples_.size());
    return samples_[(count_ - 1 - std::min(steps, kept - 1)) % samples_.size()];
  }
  // Interpolates between two samples.
  Pose pose_back(double steps) const {
    const auto whole = static_cast<std::size_t>(steps);
    const double rest = steps - static_cast<double>(whole);
    const Pose& newer = back(whole).X_WB;
    if (rest == 0) return newer;
    const Pose& older = back(whole + 1).X_WB;
    return {newer.p + rest * (older.p - newer.p), newer.q.slerp(rest, older.q)};
  }

  // The angular velocity in B, interpolated between two samples.
  Eigen::Vector3d rate_back(double steps) const {
    const auto whole = static_cast<std::size_t>(steps);
    const double rest = steps - static_cast<double>(whole);
    Eigen::Vector3d newer = rate_in_body(back(whole));
    if (rest == 0) return newer;
    return newer + rest * (rate_in_body(back(whole + 1)) - newer);
  }

 private:
  static Eigen::Vector3d rate_in_body(const MotionSample& sample) {
    return sample.X_WB.q.conjugate() * sample.w_WB_radps;
  }

  std::vector<MotionSample> samples_;
  std::size_t count_ = 0;
};

}  // namespace kenaf::physics
