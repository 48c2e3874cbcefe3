// Values of a world's interface: settings, identifiers of robots and boxes, and states of a robot.
// SI units; frames W of the world and B of the robot's body as in physics/world.hpp.
//
// Thread safety: values.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>

#include "physics/pose.hpp"
#include "robot/parts.hpp"

namespace kenaf::physics {

struct PhysicsSettings {
  double time_step_s = 0.001;
  int solver_iterations = 10;  // warm-started; more change a turn in place by less than 0.01 %
  // Compliance of rubber and ground at one contact point, which distributes a load over the points of a track.
  double contact_stiffness_npm = 2e5;
  double contact_damping_nspm = 1000;

  bool operator==(const PhysicsSettings&) const = default;
};

// Pairs of bodies near each other, beyond which boxes meet only the ground: neither each other nor robots. Chosen: more
// than twice the pairs of a pile of a thousand boxes, or of a robot among them.
inline constexpr std::size_t kMostPairs = 4096;

// Never used twice in one World.
enum class RobotId : std::uint32_t {};
enum class BoxId : std::uint32_t {};

// The exact state of a robot, without sensors.
struct RobotTruth {
  Pose X_WB;
  Eigen::Vector3d v_WB_mps, w_WB_radps;  // of the body frame's origin, in W
  std::array<double, robot::kTrackCount> track_mps, track_m;
  std::array<double, robot::kTrackCount> track_force_n;  // motor's at the belt, + pushes the robot forward
  std::array<double, robot::kFlipperCount> flipper_rad, flipper_radps, flipper_nm;
  std::array<double, robot::kFlipperCount> servo_rad;  // on the servo's side of play and compliance, if there are any
  double battery_v, battery_left_s;
};

// Motion of a robot as a rigid body on running belts.
struct RobotMotion {
  Eigen::Vector3d v_WB_mps{0, 0, 0}, w_WB_radps{0, 0, 0};  // of the body frame's origin, in W; flippers move with it
  std::array<double, robot::kTrackCount> track_mps{};
};

// Motor currents, as the drives would measure them without noise.
struct DriveCurrents {
  std::array<double, robot::kTrackCount> track_a{};
  std::array<double, robot::kFlipperCount> flipper_a{};
};

struct RayHit {
  double distance_m;
  Eigen::Vector3d normal_W;
};

}  // namespace kenaf::physics
