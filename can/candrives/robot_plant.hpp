// The motors drive the tracks and flippers of the simulated robot (physics/world.hpp), which starts at the start pose
// of its world.
#pragma once

#include <array>
#include <functional>
#include <string>

#include "can/candrives/plant.hpp"
#include "physics/world.hpp"

namespace kenaf::candrives {

class RobotPlant final : public Plant {
 public:
  // Takes shipped names or files of a robot and a world. Throws DescriptionError.
  // `speed_loop_s`: time constant of the track drives' own speed control, replacing the description's, which includes
  // ramps.
  RobotPlant(const std::string& robot, const std::string& world, double speed_loop_s,
             double time_step_s = physics::PhysicsSettings{}.time_step_s);

  // Makes as many whole physics steps as are due; the remainder of `step` is kept for the next call. Throws
  // std::runtime_error if the simulation of the robot has failed.
  void advance(canopen::Time step, const PlantCommand& command) override;
  const PlantState& state() const override { return state_; }

  // Robot time since the robot was placed.
  double time_s() const { return world_.time_s(); }
  physics::RobotTruth truth() const { return world_.truth(robot_); }
  std::function<void()> on_step;  // called after each physics step

 private:
  void observe();

  physics::World world_;
  physics::RobotId robot_{};
  std::array<double, robot::kTrackCount> encoder_factor_{};  // metres reported by the motors' encoders per true metre
  double min_flipper_rad_ = 0, max_flipper_rad_ = 0;
  canopen::Time step_, due_{};
  PlantState state_;
  std::vector<physics::SensorSample> samples_;
};

}  // namespace kenaf::candrives
