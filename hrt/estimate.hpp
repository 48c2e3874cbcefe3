// The measured quantities of a cycle as the motions use them. SI units, REP 103.
#pragma once

#include <array>
#include <cstdint>

#include "robot/state.hpp"

namespace kenaf::hrt {

struct Estimate {
  std::uint32_t frame = 0;
  double t_s = 0;   // since the first cycle, in whole nanoseconds; never decreases, unlike the clock of a reset world
  double dt_s = 0;  // since the previous cycle; 0 in the first one
  // The robot's clock went back in this cycle: its world was reset, and the robot is where it was not driven to.
  bool world_was_reset = false;
  bool has_encoders = false;
  bool has_currents = false;
  double heading_rad = 0;  // unwrapped: counts full turns; smoothed if from the orientation sensor
  double travel_m = 0;     // mean of both tracks
  double still_s = 0;      // time for which both tracks have stood still
  double max_track_a = 0;  // the larger magnitude of the two currents
  // Since the first cycle; a world's reset adds nothing, although it moves the robot.
  double odometry_x_m = 0, odometry_y_m = 0, odometry_yaw_rad = 0;
};

struct EstimatorSettings {
  double track_gauge_m;
  double turn_efficiency;  // used without an orientation sensor
};

class Estimator {
 public:
  explicit Estimator(const EstimatorSettings& settings) : settings_(settings) {}
  const Estimate& update(const robot::State& state);

 private:
  EstimatorSettings settings_;
  Estimate estimate_;
  std::int64_t t_ns_ = 0, passed_ns_ = 0;  // robot clock in the newest cycle; time passed on it
  bool started_ = false;
  bool has_posture_ = false;  // was seen, since the world's reset if there was one: before that, and while it is lost,
                              // the heading comes from the encoders
  double posture_gap_s_ = 0,
         gap_turn_rad_ = 0;        // time since it was last seen; turn by the encoders that is not yet counted
  double posture_offset_rad_ = 0;  // heading minus the sensor's yaw
  bool has_travel_ = false;
  double raw_heading_rad_ = 0;  // unwrapped, not smoothed
  double start_heading_rad_ = 0;
  std::array<double, robot::kTrackCount> track_m_{};
  std::array<double, robot::kTrackCount> still_track_m_{};  // track positions when still_s began
};

}  // namespace kenaf::hrt
