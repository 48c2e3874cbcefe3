// The values that a world takes and gives: its settings, names for robots and boxes, and how a robot stands and moves.
// SI units; frame W: x forward, y left, z up; B: the robot's body.
//
// Thread safety: values.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "physics/pose.hpp"
#include "robot/parts.hpp"

namespace kenaf::physics {

struct PhysicsSettings {
  double time_step_s = 0.001;
  int solver_iterations = 10;  // started from the last step; more changes a turn in place by less than 0.01 %
  // Of one contact point: the give of rubber and ground, which shares a load between the points of a track.
  double contact_stiffness_npm = 2e5;
  double contact_damping_nspm = 1000;

  bool operator==(const PhysicsSettings&) const = default;
};

// Never used twice in one World.
enum class RobotId : std::uint32_t {};
enum class BoxId : std::uint32_t {};

// The exact state of a robot, without sensors in between.
struct RobotTruth {
  Pose X_WB;
  Eigen::Vector3d v_WB_mps, w_WB_radps;  // of the body frame's origin, in W
  std::array<double, robot::kTrackCount> track_mps, track_m;
  std::array<double, robot::kTrackCount> track_force_n;  // motor's at the belt, + pushes the robot forward
  std::array<double, robot::kFlipperCount> flipper_rad, flipper_radps, flipper_nm;
  std::array<double, robot::kFlipperCount> servo_rad;  // on the servo's side of play and compliance, if there are any
  double battery_v, battery_left_s;
};

// How a robot moves, as a rigid body on belts that run.
struct RobotMotion {
  Eigen::Vector3d v_WB_mps{0, 0, 0}, w_WB_radps{0, 0, 0};  // of the body frame's origin, in W; flippers move with it
  std::array<double, robot::kTrackCount> track_mps{};
};

// What the motors take, as the drives' own measurement would say it without noise.
struct DriveCurrents {
  std::array<double, robot::kTrackCount> track_a{};
  std::array<double, robot::kFlipperCount> flipper_a{};
};

struct RayHit {
  double distance_m;
  Eigen::Vector3d normal_W;
};

}  // namespace kenaf::physics
