#include <cmath>

#include "physics/sensors/measure.hpp"
#include "robot/angles.hpp"

namespace kenaf::physics {
namespace {

std::int64_t counts_of(double track_m, const TrackDriveDescription& drive) {
  return std::llround(std::floor(track_m / drive.sprocket_radius_m * drive.encoder_counts_per_radian));
}

}  // namespace

EncoderReading measure_encoder(const SensorDescription& sensor, SensorState& state, const MotionSample& now,
                               const TrackDriveDescription& drive) {
  EncoderReading reading{};
  for (const robot::Track side : {robot::kLeft, robot::kRight}) {
    const double jitter_m = state.noise.normal(sensor.noise_rad) * drive.sprocket_radius_m;
    reading.counts[side] = counts_of(now.track_m[side] + jitter_m, drive) - counts_of(state.start_track_m[side], drive);
  }
  return reading;
}

DrivesReading measure_drives(const SensorDescription& sensor, SensorState& state, const MotionSample& now,
                             const FlipperServoDescription& servo) {
  DrivesReading reading{now.track_a, now.flipper_a, now.battery_v + state.noise.normal(sensor.noise_v), now.servo_rad};
  for (double& current : reading.track_a) current += state.noise.normal(sensor.noise_a);
  for (double& current : reading.flipper_a) current += state.noise.normal(sensor.noise_a);
  for (double& angle : reading.flipper_rad) {
    angle += state.noise.normal(sensor.noise_rad);
    if (servo.resolution_rad > 0) angle = std::round(angle / servo.resolution_rad) * servo.resolution_rad;
  }
  return reading;
}

OdometryReading measure_odometry(const SensorState& state, const MotionSample& now) {
  // The pose relative to that at the last reset, in the frame of that pose.
  const Eigen::Vector3d& start = state.start_odometry;
  const double dx = now.odometry.x() - start.x(), dy = now.odometry.y() - start.y();
  const double c = std::cos(start.z()), s = std::sin(start.z());
  return {c * dx + s * dy, -s * dx + c * dy, robot::wrap_angle(now.odometry.z() - start.z())};
}

TachometerReading measure_tachometer(const SensorDescription& sensor, SensorState& state, const MotionSample& now,
                                     const TrackDriveDescription& drive) {
  TachometerReading reading{};
  for (const robot::Track side : {robot::kLeft, robot::kRight}) {
    reading.spin_radps[side] = now.track_mps[side] / drive.sprocket_radius_m + state.noise.normal(sensor.noise_radps);
    reading.angle_rad[side] = (now.track_m[side] - state.start_track_m[side]) / drive.sprocket_radius_m;
  }
  return reading;
}

Eigen::Vector3d advance_odometry(const Eigen::Vector3d& odometry,
                                 const std::array<double, robot::kTrackCount>& old_track_m,
                                 const std::array<double, robot::kTrackCount>& new_track_m,
                                 const RobotDescription& robot) {
  const double metres = robot.drive.sprocket_radius_m / robot.drive.encoder_counts_per_radian;
  const auto moved = [&](robot::Track side) {
    return static_cast<double>(counts_of(new_track_m[side], robot.drive) - counts_of(old_track_m[side], robot.drive)) *
           metres;
  };
  // Without slip: turn = (right - left) / gauge, and the mean along the heading half way through the turn.
  const double left = moved(robot::kLeft), right = moved(robot::kRight);
  const double turn = (right - left) / robot.track_gauge_m();
  const double ahead = (left + right) / 2, heading = odometry.z() + turn / 2;
  return {odometry.x() + ahead * std::cos(heading), odometry.y() + ahead * std::sin(heading), odometry.z() + turn};
}

}  // namespace kenaf::physics
