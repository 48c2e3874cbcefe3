// Turns commands, sensor readings and motion capture into the rows of a run.
//
// Thread safety: none; one thread owns a RunRecorder.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "physics/noise.hpp"
#include "robot/columns.hpp"
#include "rollout/manoeuvre.hpp"
#include "rollout/roll_out.hpp"
#include "rollout/tracking.hpp"

namespace kenaf::rollout {

// Returns `robot` with only the sensors that a run has columns for, the first of each type, and all noise scaled.
physics::RobotDescription instrumented(physics::RobotDescription robot, double noise_scale);

class RunRecorder {
 public:
  // `robot` as instrumented() makes it; must outlive this. `start`: of the run that is replayed, if one is.
  RunRecorder(const physics::RobotDescription& robot, const RollOutOptions& options, const std::optional<Start>& start);

  void add(double t_s, const robot::Command& command, const physics::RobotTruth& truth,
           std::span<const physics::SensorSample> samples);
  // A pose after the last row, which motion capture with a clock that is ahead shows in one of the rows. (That of a row
  // is added with it.)
  void add_pose(double t_s, const physics::RobotTruth& truth);
  // Returns the rows that were added and empties the recorder.
  runs::Run take();

 private:
  // Adjacent columns, by the first one; none if the robot does not measure them.
  struct Group {
    std::size_t first = 0, count = 0;
  };
  Group add_group(bool measured, robot::Quantity quantity);
  void put(Group group, std::initializer_list<double> values);
  void put_poses();

  void put_reading(const physics::InsReading& reading);
  void put_reading(const physics::ImuReading& reading);
  void put_reading(const physics::EncoderReading& reading);
  void put_reading(const physics::TachometerReading& reading);
  void put_reading(const physics::DrivesReading& reading);
  template <typename Other>
  void put_reading(const Other&) {}

  const physics::RobotDescription& robot_;
  double mocap_noise_m_, mocap_noise_rad_;
  physics::NoiseSource mocap_noise_;
  std::optional<TrackedPose> first_report_;
  bool starts_in_motion_;
  PoseCourse course_;                    // the poses of all rows, then the later ones
  std::vector<TrackedPose> pose_noise_;  // of each row, since it does not depend on the pose's time
  runs::Run run_;
  Group time_, cmd_track_, cmd_flipper_, track_speed_, track_travel_, flipper_, track_current_, flipper_current_,
      battery_, position_, tilt_, yaw_, gyro_, acceleration_;
};

}  // namespace kenaf::rollout
