#include "can/candrives/robot_plant.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace kenaf::candrives {

namespace {

physics::WorldDescription world_description(const std::string& world) {
  std::vector<std::string> unsupported;
  return physics::load_world(world, unsupported);
}

// Keeps only the drive sensor, which measures currents, voltage and servo angles, in each step.
physics::RobotDescription with_drive_sensor(physics::RobotDescription robot) {
  std::erase_if(robot.sensors, [](const auto& sensor) { return sensor.type != physics::SensorType::drives; });
  if (robot.sensors.empty()) {
    physics::SensorDescription drives{};
    drives.type = physics::SensorType::drives;
    drives.name = "Drives";
    robot.sensors.push_back(drives);
  }
  robot.sensors.resize(1);
  robot.sensors.front().period_s = robot.sensors.front().delay_s = 0;
  return robot;
}

}  // namespace

RobotPlant::RobotPlant(const std::string& robot, const std::string& world, double speed_loop_s, double time_step_s)
    : world_(world_description(world), physics::PhysicsSettings{.time_step_s = time_step_s}, 0) {
  physics::RobotDescription description = with_drive_sensor(physics::load_robot(robot));
  description.drive.time_constant_s = speed_loop_s;
  encoder_factor_ = {description.encoder_factor(robot::kLeft), description.encoder_factor(robot::kRight)};
  if (description.has_flippers()) {
    min_flipper_rad_ = description.flipper.front().min_angle_rad;
    max_flipper_rad_ = description.flipper.front().max_angle_rad;
  }
  step_ = std::chrono::nanoseconds(std::llround(world_.settings().time_step_s * 1e9));
  robot_ = world_.add_robot(description, description.name, world_.description().start_poses.front().X_WB);
  observe();
}

void RobotPlant::advance(canopen::Time step, const PlantCommand& command) {
  robot::Command commanded;
  commanded.track_speed_mps = command.track_mps;
  // beyond its stop a joint angle is a direction, which could be reached the other way round
  for (std::size_t i = 0; i < robot::kFlipperCount; ++i)
    commanded.flipper[i] = {robot::JointMode::angle,
                            std::clamp(command.flipper_rad[i], min_flipper_rad_, max_flipper_rad_)};
  world_.set_command(robot_, commanded);
  for (due_ += step; due_ >= step_; due_ -= step_) {
    world_.step();
    if (on_step) on_step();
  }
  observe();
}

void RobotPlant::observe() {
  if (const std::string& fault = world_.fault(robot_); !fault.empty())
    throw std::runtime_error("the simulation of the robot has failed: " + fault);

  // The true motion. Encoders count belt travel times their factor; the gyro sees w_B = R_WB^T w_W, its z component.
  const physics::RobotTruth truth = world_.truth(robot_);
  const Eigen::Vector3d angles_rad = physics::roll_pitch_yaw(truth.X_WB.q);
  const Eigen::Vector3d w_WB_B = truth.X_WB.q.conjugate() * truth.w_WB_radps;
  for (std::size_t i = 0; i < robot::kTrackCount; ++i) {
    state_.track_m[i] = truth.track_m[i] * encoder_factor_[i];
    state_.track_mps[i] = truth.track_mps[i] * encoder_factor_[i];
  }
  state_.flipper_rad = truth.servo_rad;
  state_.flipper_radps = truth.flipper_radps;
  state_.battery_v = truth.battery_v;
  state_.roll_rad = angles_rad.x();
  state_.pitch_rad = angles_rad.y();
  state_.yaw_rate_radps = w_WB_B.z();

  // The drives' own sensor has the currents, and measures voltage and servo angles in place of the true values above.
  samples_.clear();
  world_.read_sensors(robot_, samples_);
  for (const physics::SensorSample& sample : samples_) {
    const auto* drives = std::get_if<physics::DrivesReading>(&sample.reading);
    if (drives == nullptr) continue;
    state_.track_a = drives->track_a;
    state_.flipper_a = drives->flipper_a;
    state_.battery_v = drives->battery_v;
    state_.flipper_rad = drives->flipper_rad;
  }
}

}  // namespace kenaf::candrives
