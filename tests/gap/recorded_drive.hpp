// A drive whose speed and turn rate are known functions of time, as a robot and a motion-capture system record it.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "formats/runs/run_file.hpp"
#include "gap/logs/motion_capture.hpp"

namespace kenaf::test {

struct Drive {
  std::function<double(double)> speed_mps, turn_radps;
  double duration_s;
};

// Stands for a second, then drives on curves of four frequencies that no small whole numbers relate, so that no part of
// it is like another; stands at the end.
inline Drive winding_drive(double duration_s = 20) {
  const auto share = [duration_s](double t) {
    return std::clamp(t - 1, 0.0, 1.0) * std::clamp(duration_s - 1 - t, 0.0, 1.0);
  };
  return {[share](double t) { return share(t) * (0.25 + 0.1 * std::sin(0.7 * t) + 0.1 * std::sin(1.9 * t + 1)); },
          [share](double t) { return share(t) * (0.5 * std::sin(0.9 * t) + 0.3 * std::sin(2.3 * t)); }, duration_s};
}

struct PlanarPose {
  double x_m = 0, y_m = 0, yaw_rad = 0;
};

// Integrated by the midpoint rule in steps of 1 ms: exact to (1 ms)^2.
class DrivenPath {
 public:
  explicit DrivenPath(const Drive& drive) {
    poses_.push_back({});
    for (int i = 0; i * kStep_s < drive.duration_s + 1; ++i) {
      const double t = (i + 0.5) * kStep_s;
      PlanarPose pose = poses_.back();
      const double yaw = pose.yaw_rad + 0.5 * kStep_s * drive.turn_radps(t);
      pose.x_m += kStep_s * drive.speed_mps(t) * std::cos(yaw);
      pose.y_m += kStep_s * drive.speed_mps(t) * std::sin(yaw);
      pose.yaw_rad += kStep_s * drive.turn_radps(t);
      poses_.push_back(pose);
    }
  }
  PlanarPose at(double t_s) const {
    const auto i = static_cast<std::size_t>(t_s / kStep_s);
    const double share = t_s / kStep_s - static_cast<double>(i);
    const PlanarPose &a = poses_[i], &b = poses_[i + 1];
    return {std::lerp(a.x_m, b.x_m, share), std::lerp(a.y_m, b.y_m, share), std::lerp(a.yaw_rad, b.yaw_rad, share)};
  }

 private:
  static constexpr double kStep_s = 0.001;
  std::vector<PlanarPose> poses_;
};

// What the robot's log holds: 100 Hz, track speeds with noise of 5 mm/s, where wanted a gyro with 0.005 rad/s. On the
// ground it turns by half of what its tracks, 0.4 m apart, differ by.
inline runs::Run robot_log(const Drive& drive, unsigned seed, bool gyro = true) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise;
  runs::Run run;
  run.columns = {"t_s", "track_left_mps", "track_right_mps"};
  if (gyro) run.columns.push_back("gyro_z_radps");
  run.values.resize(run.columns.size());
  for (int i = 0; i * 0.01 <= drive.duration_s; ++i) {
    const double t = i * 0.01, v = drive.speed_mps(t), w = drive.turn_radps(t);
    run.values[0].push_back(t);
    run.values[1].push_back(v - 0.4 * w + 0.005 * noise(random));
    run.values[2].push_back(v + 0.4 * w + 0.005 * noise(random));
    if (gyro) run.values[3].push_back(w + 0.005 * noise(random));
  }
  return run;
}

struct CaptureOptions {
  double offset_s = 0;            // robot's time less the capture's
  double from_s = 0, to_s = 1e9;  // of the robot's time
  double period_s = 1 / 120.0;
  double noise = 1;  // times 1 mm and 2 mrad
  double frame_yaw_rad = 0, frame_x_m = 0, frame_y_m = 0;
  double drift = 0;  // growth of the offset per second of robot's time; the offset is that at 0
};

inline gap::logs::MotionCapture captured(const Drive& drive, unsigned seed, const CaptureOptions& options) {
  std::mt19937 random(seed + 1000);
  std::normal_distribution<double> noise;
  const DrivenPath path(drive);
  const Eigen::Rotation2Dd frame(options.frame_yaw_rad);
  gap::logs::MotionCapture capture{{}, true, true};
  const double to_s = std::min(options.to_s, drive.duration_s);
  for (int i = 0; options.from_s + i * options.period_s <= to_s; ++i) {
    const double t = options.from_s + i * options.period_s;
    const PlanarPose pose = path.at(t);
    const double x = pose.x_m + options.noise * 0.001 * noise(random);
    const double y = pose.y_m + options.noise * 0.001 * noise(random);
    const Eigen::Vector2d p = frame * Eigen::Vector2d(x, y) + Eigen::Vector2d(options.frame_x_m, options.frame_y_m);
    const double yaw = options.frame_yaw_rad + pose.yaw_rad + options.noise * 0.002 * noise(random);
    capture.poses.push_back({t - options.offset_s - options.drift * t,
                             {p.x(), p.y(), 0.09},
                             Eigen::Quaterniond(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()))});
  }
  return capture;
}

}  // namespace kenaf::test
