// The robot's heading from a yaw-rate gyro: integrated SYNC by SYNC, its bias learnt whenever the robot stands.
//
// The rate about the body's z axis is taken as the yaw rate, multiplied by cos(roll) / cos(pitch) of z-y-x angles,
// without the contribution of the unmeasured pitch rate: exact on level ground and along a slope, wrong while a rolled
// robot pitches. A gyro's bias drifts; between stands of the robot the heading drifts with it.
#pragma once

#include <optional>

namespace kenaf::real {

class Heading {
 public:
  // `dt_s`: time since the previous sample; `standing`: tracks at rest and commanded to be.
  void update(double rate_radps, double roll_rad, double pitch_rad, bool standing, double dt_s);

  double yaw_rad() const { return yaw_rad_; }  // in (-pi, pi]; 0 at the start
  double bias_radps() const { return bias_radps_; }
  // The rate of a gyro that has shown too much of it to be learnt for most of the time that the robot stood: the
  // heading drifts by as much. nullopt: the bias was learnt, or the robot has not stood yet.
  std::optional<double> unlearnt_radps() const;

 private:
  double yaw_rad_ = 0, bias_radps_ = 0;
  double standing_s_ = 0, learnt_s_ = 0;
  double refused_s_ = 0, last_refused_radps_ = 0;  // while it stood
};

}  // namespace kenaf::real
