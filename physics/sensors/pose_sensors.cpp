#include "physics/sensors/measure.hpp"
#include "protocol/frames.hpp"

namespace kenaf::physics {
namespace {

Eigen::Vector3d wrapped(const Eigen::Vector3d& angles) {
  return {frames::wrap_angle(angles.x()), frames::wrap_angle(angles.y()), frames::wrap_angle(angles.z())};
}

}  // namespace

GroundTruthReading measure_ground_truth(const MotionSample& now) {
  return {now.X_WB.p, roll_pitch_yaw(now.X_WB.q)};
}

InsReading measure_ins(const SensorDescription& sensor, SensorState& state, const MotionSample& now) {
  const Pose X = compose(state.X_given_true, now.X_WB);
  const Eigen::Vector3d position = X.p + state.noise.normal3(sensor.noise_m);
  return {position, wrapped(roll_pitch_yaw(X.q) + state.bias_rad + state.noise.normal3(sensor.noise_rad))};
}

ImuReading measure_imu(const SensorDescription& sensor, SensorState& state, const MotionSample& now,
                       const MotionSample& before, const Eigen::Vector3d& gravity_W_mps2) {
  const double dt = now.t_s - before.t_s;
  // velocity where the sensor is mounted
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
  reading.angular_velocity_radps = q_BW * now.w_WB_radps + state.bias_radps + state.noise.normal3(sensor.noise_radps);
  reading.angular_acceleration_radps2 = q_BW * turn_W;
  reading.roll_pitch_yaw_rad =
      wrapped(roll_pitch_yaw(now.X_WB.q) + state.bias_rad + state.noise.normal3(sensor.noise_rad));
  return reading;
}

}  // namespace kenaf::physics
