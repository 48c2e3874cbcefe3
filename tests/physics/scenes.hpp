// Worlds and robots that the tests of this room share.
#pragma once

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "physics/world.hpp"

namespace kenaf::physics {

inline constexpr double kGravity = 9.80665;

// Level ground, turned by `pitch_rad` about y: positive falls away forward.
inline WorldDescription ground(double friction = 1, double pitch_rad = 0) {
  WorldDescription world;
  world.name = "test";
  world.planes.push_back({{Eigen::Vector3d::Zero(), rotation_from({0, pitch_rad, 0})}, friction});
  world.start_poses.push_back({"start", {}});
  return world;
}

inline Box fixed_box(const Eigen::Vector3d& size_m, const Eigen::Vector3d& center_m, double yaw_rad = 0) {
  return {"box", size_m, {center_m, rotation_from({0, 0, yaw_rad})}, 1, 0};
}

inline Box loose_box(const Eigen::Vector3d& size_m, const Pose& X_WBox, double mass_kg, double friction) {
  return {"box", size_m, X_WBox, friction, mass_kg};
}

// Two slopes of 2 m by 4 m that fall from a ridge along y at x = 0 to z = 0 at x = 2 m and -2 m.
inline TriangleMesh roof(double ridge_m) {
  return {"roof",
          {{-2, -2, 0}, {0, -2, ridge_m}, {2, -2, 0}, {-2, 2, 0}, {0, 2, ridge_m}, {2, 2, 0}},
          {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}},
          1};
}

// Kenaf without flippers, of one friction coefficient in all directions.
inline RobotDescription plain_tracks(double friction) {
  RobotDescription robot = load_robot("kenaf");
  robot.flipper.clear();
  robot.track.front().friction_along = robot.track.front().friction_across = friction;
  robot.track.front().lug_height_m = 0;  // lugs hold at an edge even where the belt is smooth
  return robot;
}

// Kenaf with its front pair of flippers alone, or its rear one.
inline RobotDescription kenaf_with_pair(bool front) {
  RobotDescription robot = load_robot("kenaf");
  robot.flipper_pairs = {.front = front, .rear = !front};
  return robot;
}

inline void run(World& world, double time_s) {
  const auto steps = std::lround(time_s / world.settings().time_step_s);
  for (long i = 0; i < steps; ++i) world.step();
}

inline robot::Command drive(double left_mps, double right_mps, double front_rad = 1, double rear_rad = 1) {
  robot::Command command;
  command.track_speed_mps = {left_mps, right_mps};
  for (const robot::Flipper f : {robot::kFrontLeft, robot::kFrontRight})
    command.flipper[f] = {robot::JointMode::angle, front_rad};
  for (const robot::Flipper f : {robot::kRearLeft, robot::kRearRight})
    command.flipper[f] = {robot::JointMode::angle, rear_rad};
  return command;
}

inline double yaw_of(const Pose& X) {
  return roll_pitch_yaw(X.q).z();
}

}  // namespace kenaf::physics
