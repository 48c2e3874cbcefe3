// One function for each kind of sensor, from the robot's motion to the reading. docs/physics.md describes the models.
#pragma once

#include <functional>
#include <optional>

#include "physics/noise.hpp"
#include "physics/readings.hpp"
#include "physics/robot_description.hpp"
#include "physics/sensors/motion_history.hpp"

namespace kenaf::physics {

// State of a sensor between its reports.
struct SensorState {
  explicit SensorState(const NoiseSource& source) : noise(source) {}
  NoiseSource noise;
  Eigen::Vector3d bias_rad{0, 0, 0}, bias_radps{0, 0, 0};
  // start of its integration
  std::array<double, robot::kTrackCount> start_track_m{};
  Eigen::Vector3d start_odometry{0, 0, 0};
  Pose X_given_true;  // INS: maps the true pose to the one that it was set to
};

// An inclinometer: measures posture against gravity, not against the world's axes.
class PostureSense {
 public:
  PostureSense(const Effects& effects, const Eigen::Vector3d& gravity_W_mps2);

  // Returns the pose turned so that gravity points along -z; if it does so in W, with the same bits.
  Pose leveled(const Pose& X_WB) const { return {X_WB.p, q_LW_ * X_WB.q}; }
  // Returns roll, pitch, yaw of a levelled pose, with the errors that effects give the sensor.
  Eigen::Vector3d sensed(const Eigen::Quaterniond& q_LB) const;

 private:
  Eigen::Quaterniond q_LW_;
  double mount_rad_, scale_, bias_rad_;
};

// A gyro with the errors that effects give it.
class GyroSense {
 public:
  explicit GyroSense(const Effects& effects)
      : scale_(effects.gyro_scale), bias_B_radps_(0, 0, effects.gyro_bias_z_radps) {}

  // Returns the reading for an angular velocity in B.
  Eigen::Vector3d sensed(const Eigen::Vector3d& w_WB_B_radps) const { return scale_ * w_WB_B_radps + bias_B_radps_; }

 private:
  double scale_;
  Eigen::Vector3d bias_B_radps_;
};

// Motion that an IMU measures. Accelerations are the mean between `now` and `before`, one averaging time earlier.
// Effects may make pose and rates older than the nominal delay.
struct ImuMotion {
  const MotionSample &now, &before;
  Pose X_WB;
  Eigen::Vector3d gyro_B_radps;
};

GroundTruthReading measure_ground_truth(const MotionSample& now);
// `X_WB` is the measured pose, which effects may make older than the nominal delay.
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

// Returns the distance to the first surface along a ray from a point in W, if one is nearer than `max_m`.
using RayCaster = std::function<std::optional<double>(const Eigen::Vector3d& from_W, const Eigen::Vector3d& direction_W,
                                                      double max_m)>;
SonarReading measure_sonar(const SensorDescription& sensor, SensorState& state, const MotionSample& now,
                           const RayCaster& cast);
// Obstacles are taken where they are now, the robot where it was the sensor's delay ago.
RangeScanReading measure_range_scanner(const SensorDescription& sensor, SensorState& state, const MotionSample& now,
                                       const RayCaster& cast);
GpsReading measure_gps(const SensorDescription& sensor, SensorState& state, const MotionSample& now,
                       const RayCaster& cast);

}  // namespace kenaf::physics
