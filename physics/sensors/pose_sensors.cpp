#include <algorithm>
#include <cmath>

#include "physics/sensors/measure.hpp"
#include "robot/angles.hpp"

namespace kenaf::physics {
namespace {

Eigen::Vector3d wrapped(const Eigen::Vector3d& angles) {
  return {robot::wrap_angle(angles.x()), robot::wrap_angle(angles.y()), robot::wrap_angle(angles.z())};
}

}  // namespace

PostureSense::PostureSense(const Effects& effects, const Eigen::Vector3d& gravity_W_mps2)
    : q_LW_(leveling(gravity_W_mps2)),
      mount_rad_(effects.posture_mount_rad),
      scale_(effects.posture_scale),
      bias_rad_(effects.posture_bias_rad) {}

Eigen::Vector3d PostureSense::sensed(const Eigen::Quaterniond& q_LB) const {
  Eigen::Vector3d angles = roll_pitch_yaw(q_LB);
  if (mount_rad_ != 0) {
    // Roll and pitch are about the sensor's own axes; its heading is aligned with the body's.
    const Eigen::Quaterniond q_BS(Eigen::AngleAxisd(mount_rad_, Eigen::Vector3d::UnitZ()));
    angles.head<2>() = roll_pitch_yaw(q_LB * q_BS).head<2>();
  }
  return {scale_ * angles.x(), scale_ * angles.y() + bias_rad_, angles.z()};
}

GroundTruthReading measure_ground_truth(const MotionSample& now) {
  return {now.X_WB.p, roll_pitch_yaw(now.X_WB.q)};
}

InsReading measure_ins(const SensorDescription& sensor, SensorState& state, const Pose& X_WB,
                       const PostureSense& posture) {
  const Pose X = compose(state.X_given_true, posture.leveled(X_WB));
  const Eigen::Vector3d position = X.p + state.noise.normal3(sensor.noise_m);
  return {position, wrapped(posture.sensed(X.q) + state.bias_rad + state.noise.normal3(sensor.noise_rad))};
}

ImuReading measure_imu(const SensorDescription& sensor, SensorState& state, const ImuMotion& motion,
                       const Eigen::Vector3d& gravity_W_mps2, const PostureSense& posture) {
  const auto& [now, before, X_WB, gyro_B_radps] = motion;
  const double dt = now.t_s - before.t_s;
  // Proper acceleration is the change of velocity at the mount, v + w x r, over dt, minus gravity.
  const auto velocity = [&sensor](const MotionSample& s) -> Eigen::Vector3d {
    return s.v_WB_mps + s.w_WB_radps.cross(s.X_WB.q * sensor.X_BS.p);
  };
  Eigen::Vector3d acceleration_W = -gravity_W_mps2, turn_W(0, 0, 0);
  if (dt > 0) {
    acceleration_W += (velocity(now) - velocity(before)) / dt;
    turn_W = (now.w_WB_radps - before.w_WB_radps) / dt;
  }
  const Eigen::Quaterniond q_BW = now.X_WB.q.conjugate();
  ImuReading reading;
  reading.acceleration_mps2 = q_BW * acceleration_W + state.noise.normal3(sensor.noise_mps2);
  reading.angular_velocity_radps = gyro_B_radps + state.bias_radps + state.noise.normal3(sensor.noise_radps);
  reading.angular_acceleration_radps2 = q_BW * turn_W;
  reading.roll_pitch_yaw_rad =
      wrapped(posture.sensed(posture.leveled(X_WB).q) + state.bias_rad + state.noise.normal3(sensor.noise_rad));
  return reading;
}

}  // namespace kenaf::physics
