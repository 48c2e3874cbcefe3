// One function for each kind of sensor: from what the robot did to what the sensor reports. docs/physics.md says what
// each one models.
#pragma once

#include <functional>
#include <optional>

#include "physics/noise.hpp"
#include "physics/readings.hpp"
#include "physics/robot_description.hpp"
#include "physics/sensors/motion_history.hpp"

namespace kenaf::physics {

// What a sensor carries from one report to the next.
struct SensorState {
  explicit SensorState(const NoiseSource& source) : noise(source) {}
  NoiseSource noise;
  Eigen::Vector3d bias_rad{0, 0, 0}, bias_radps{0, 0, 0};
  // where its integration started
  std::array<double, robot::kTrackCount> start_track_m{};
  Eigen::Vector3d start_odometry{0, 0, 0};
  Pose X_given_true;  // INS: turns the true pose into the one it was told to have
};

// What an inclinometer makes of a pose: posture is against gravity, whatever way the world's axes point.
class PostureSense {
 public:
  PostureSense(const Effects& effects, const Eigen::Vector3d& gravity_W_mps2);

  // Turned so that gravity points along -z; where gravity does so in W, the same bits.
  Pose leveled(const Pose& X_WB) const { return {X_WB.p, q_LW_ * X_WB.q}; }
  // Roll, pitch, yaw of a level pose, with the faults that the effects give the sensor.
  Eigen::Vector3d sensed(const Eigen::Quaterniond& q_LB) const;

 private:
  Eigen::Quaterniond q_LW_;
  double mount_rad_, scale_, bias_rad_;
};

// What a gyro makes of a robot's angular velocity.
class GyroSense {
 public:
  explicit GyroSense(const Effects& effects)
      : scale_(effects.gyro_scale), bias_B_radps_(0, 0, effects.gyro_bias_z_radps) {}

  // Of an angular velocity in B.
  Eigen::Vector3d sensed(const Eigen::Vector3d& w_WB_B_radps) const { return scale_ * w_WB_B_radps + bias_B_radps_; }

 private:
  double scale_;
  Eigen::Vector3d bias_B_radps_;
};

// What an IMU reports of. Accelerations are the mean between `now` and `before`, which is one averaging time earlier.
// Pose and rates may be older than the nominal delay says.
struct ImuMotion {
  const MotionSample &now, &before;
  Pose X_WB;
  Eigen::Vector3d gyro_B_radps;
};

GroundTruthReading measure_ground_truth(const MotionSample& now);
// `X_WB` is the pose that the sensor reports, which may be an older one than the nominal delay says.
InsReading measure_ins(const SensorDescription& sensor, SensorState& state, const Pose& X_WB,
                       const PostureSense& posture);
ImuReading measure_imu(const SensorDescription& sensor, SensorState& state, const ImuMotion& motion,
                       const Eigen::Vector3d& gravity_W_mps2, const PostureSense& posture);

EncoderReading measure_encoder(const SensorDescription& sensor, SensorState& state, const MotionSample& now,
                               const TrackDriveDescription& drive);
DrivesReading measure_drives(const SensorDescription& sensor, SensorState& state, const MotionSample& now,
                             const FlipperServoDescription& servo);
OdometryReading measure_odometry(const SensorState& state, const MotionSample& now);
TachometerReading measure_tachometer(const SensorDescription& sensor, SensorState& state, const MotionSample& now,
                                     const TrackDriveDescription& drive);
// Advances odometry by a step from the encoders' whole counts.
Eigen::Vector3d advance_odometry(const Eigen::Vector3d& odometry,
                                 const std::array<double, robot::kTrackCount>& old_track_m,
                                 const std::array<double, robot::kTrackCount>& new_track_m,
                                 const RobotDescription& robot);

// The distance to the first surface along a ray from a point in W, if one is nearer than `max_m`.
using RayCaster = std::function<std::optional<double>(const Eigen::Vector3d& from_W, const Eigen::Vector3d& direction_W,
                                                      double max_m)>;
SonarReading measure_sonar(const SensorDescription& sensor, SensorState& state, const MotionSample& now,
                           const RayCaster& cast);
RangeScanReading measure_range_scanner(const SensorDescription& sensor, SensorState& state, const MotionSample& now,
                                       const RayCaster& cast);
GpsReading measure_gps(const SensorDescription& sensor, SensorState& state, const MotionSample& now,
                       const RayCaster& cast);

}  // namespace kenaf::physics
