// What the motions know of the robot in a cycle, from what was measured. SI units, REP 103.
#pragma once

#include <array>
#include <cstdint>

#include "robot/state.hpp"

namespace kenaf::hrt {

struct Estimate {
  std::uint32_t frame = 0;
  double t_s = 0;   // since the first cycle, in whole nanoseconds; never goes back, as a reset world's clock does
  double dt_s = 0;  // since the cycle before; 0 in the first one
  bool has_encoders = false;
  bool has_currents = false;
  double heading_rad = 0;  // unwrapped: counts full turns; smoothed where it comes from the posture sensor
  double travel_m = 0;     // mean of both tracks
  double still_s = 0;      // how long both tracks have stood
  double max_track_a = 0;  // the larger of both currents' magnitudes
  double odometry_x_m = 0, odometry_y_m = 0, odometry_yaw_rad = 0;  // since the first cycle
};

struct EstimatorSettings {
  double track_gauge_m;
  double turn_efficiency;  // used where there is no posture sensor
};

class Estimator {
 public:
  explicit Estimator(const EstimatorSettings& settings) : settings_(settings) {}
  const Estimate& update(const robot::State& state);

 private:
  EstimatorSettings settings_;
  Estimate estimate_;
  std::int64_t t_ns_ = 0, passed_ns_ = 0;  // the robot's clock in the newest cycle, and what has passed on it
  bool started_ = false;
  bool has_posture_ = false;  // was ever seen: the heading is the encoders' before, and while it is lost
  double posture_gap_s_ = 0,
         gap_turn_rad_ = 0;        // since it was last seen; what the encoders turned and is not counted yet
  double posture_offset_rad_ = 0;  // heading minus the sensor's yaw
  bool has_travel_ = false;
  double raw_heading_rad_ = 0;  // unwrapped, not smoothed
  double start_heading_rad_ = 0;
  std::array<double, robot::kTrackCount> track_m_{};
  std::array<double, robot::kTrackCount> still_track_m_{};  // where the tracks were when still_s began
};

}  // namespace kenaf::hrt
