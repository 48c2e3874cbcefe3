// All sensors of one robot: when each is due, its delay, and its reading.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "physics/readings.hpp"
#include "physics/robot_description.hpp"
#include "physics/sensors/measure.hpp"
#include "physics/world_values.hpp"

namespace kenaf::physics {

class SensorSet {
 public:
  SensorSet(const RobotDescription& robot, const std::string& robot_name, std::uint64_t world_seed, double time_step_s,
            const Eigen::Vector3d& gravity_W_mps2);

  // Call once after placement and after each step. `touches_W`: where the robot is touched, in W.
  void record(const RobotTruth& truth, double t_s, const std::array<double, robot::kTrackCount>& track_a,
              const std::array<double, robot::kFlipperCount>& flipper_a, std::span<const Eigen::Vector3d> touches_W);
  // Call after a teleport: the jump is no motion.
  void forget_motion() { history_.clear(); }

  void read(std::uint64_t step, const RayCaster& cast, std::vector<SensorSample>& out);
  void reset(std::size_t sensor, const std::optional<GroundTruthReading>& pose);
  void reset_track(std::size_t sensor, robot::Track side);

 private:
  struct Entry {
    Entry(SensorState initial, std::size_t period, std::size_t delay)
        : state(std::move(initial)), period_steps(period), delay_steps(delay) {}
    SensorState state;
    std::size_t period_steps, delay_steps;
    std::optional<std::uint64_t> reported_step;
  };
  Reading measure(std::size_t sensor, const RayCaster& cast);

  const RobotDescription& robot_;
  double time_step_s_;
  Eigen::Vector3d gravity_W_mps2_;
  PostureSense posture_;
  GyroSense gyro_;
  double posture_delay_steps_, gyro_delay_steps_;  // beyond the sensor's own
  std::vector<Entry> entries_;
  MotionHistory history_;
  bool has_touch_ = false, has_odometry_ = false, any_recorded_ = false;
  Eigen::Vector3d odometry_{0, 0, 0};
  std::array<double, robot::kTrackCount> track_m_{};
};

}  // namespace kenaf::physics
