// The robot's heading from a yaw-rate gyro: integrated SYNC by SYNC, its bias learnt whenever the robot stands.
//
// The rate about the body's z axis is taken for the rate of yaw, divided by cos(pitch) / cos(roll) of z-y-x angles,
// without the part of the pitch rate, which is not measured: exact on level ground and along a slope, and wrong while a
// robot that is rolled pitches. A gyro's bias drifts; between stands of the robot the heading drifts with it.
#pragma once

namespace kenaf::real {

class Heading {
 public:
  // `dt_s` since the sample before; `standing`: tracks at rest and told to be.
  void update(double rate_radps, double roll_rad, double pitch_rad, bool standing, double dt_s);

  double yaw_rad() const { return yaw_rad_; }  // in (-pi, pi]; 0 at the start
  double bias_radps() const { return bias_radps_; }

 private:
  double yaw_rad_ = 0, bias_radps_ = 0;
  double standing_s_ = 0, learnt_s_ = 0;
};

}  // namespace kenaf::real
