// The scene for every engine: one robot or one loose block, on terrain of planes and boxes.
//
// Made from the project's own descriptions, so that all engines simulate the same masses, shapes and friction.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "physics/robot_description.hpp"
#include "physics/world_description.hpp"
#include "robot/command.hpp"

namespace kenaf::engines {

// Motion of belts and flippers at a time.
struct DriveSample {
  double t_s = 0;
  std::array<double, robot::kTrackCount> belt_mps{};
  std::array<double, robot::kFlipperCount> flipper_rad{};
};

struct EngineScene {
  std::string name;
  physics::WorldDescription world;                 // planes and boxes, all of them fixed
  std::optional<physics::RobotDescription> robot;  // else the block
  std::optional<physics::Box> block;
  physics::Pose X_start;  // of the robot's body frame
  robot::Command command;
  // By time, the first at 0. If there are any, belts and flippers follow them, interpolated, instead of commands.
  std::vector<DriveSample> prescribed;
  double duration_s = 0;
  double time_step_s = 0.001;
};

// The climbs that are timed. Flippers hold one posture for each obstacle.
std::vector<EngineScene> climbs();
// The robot at rest on a plane that falls away forward by `slope_rad`, flippers folded up.
EngineScene on_plane(const physics::RobotDescription& robot, double slope_rad);

// Two drums with a belt around: track (equal drums) or flipper; or a wheel, where both are one. Profile in x and z,
// swept along y.
struct Belted {
  Eigen::Vector3d p_rear_m, p_front_m;  // drum centres, of the flipper: pivot and tip
  double rear_radius_m, front_radius_m, width_m;
  double friction_along, friction_across;
  std::optional<robot::Track> belt;     // the side with whose speed it runs; none: it slides
  int boxes;                            // of the straight part, for about as many contacts as Kenaf has; 0: a wheel
  std::vector<Eigen::Vector3d> hull_m;  // corners of the convex hull of both drums
};

struct Cuboid {
  Eigen::Vector3d center_m, size_m;
};
// The straight part between the drums, cut into boxes of equal length; as high as the smaller drum. Empty for a wheel.
std::vector<Cuboid> straight_part(const Belted& shape, int boxes);

struct Arm {
  Belted shape;  // in the arm's frame: x out along the arm, origin at the pivot
  double mass_kg;
  Eigen::Vector3d p_com_m, inertia_kgm2;  // about the centre of mass
  physics::Pose X_BArm;                   // at angle 0; a positive angle turns about -y of it
};

// The flipper that the arm with this number is: of those that the robot has, in the order of robot::Flipper.
robot::Flipper flipper_of_arm(const physics::RobotDescription& robot, std::size_t arm);
// The angle of an arm before the first step.
double flipper_at_start(const EngineScene& scene, std::size_t arm);
// The largest torque of a servo; practically unlimited for prescribed angles.
double servo_torque_nm(const EngineScene& scene);

struct RobotParts {
  std::vector<Belted> tracks;  // tracks, or wheels and casters, in B
  std::vector<Arm> arms;       // of the flippers that the robot has, in the order of robot::Flipper
};
RobotParts parts_of(const physics::RobotDescription& robot);

// The drives as in physics/, without limits of force (lag of a track's speed, position loop of a flipper), or
// prescribed.
class Drives {
 public:
  explicit Drives(const EngineScene& scene);
  void advance();  // call before each step
  double belt_mps(robot::Track track) const { return belt_mps_[track]; }
  // The commanded speed of an arm at `angle_rad`; a prescribed one reaches its angle within the step.
  double flipper_radps(std::size_t arm, double angle_rad) const;
  double flipper_rad(std::size_t arm) const { return command_.flipper[first_arm_ + arm].value; }  // commanded

 private:
  void advance_as_prescribed();

  robot::Command command_;
  std::size_t first_arm_ = 0;  // which flipper it is
  std::vector<DriveSample> prescribed_;
  std::size_t next_ = 0;  // index in prescribed_ of the first sample that is not past
  double time_step_s_ = 0, time_s_ = 0;
  double share_ = 1, max_mps_ = 0, max_radps_ = 0, servo_gain_per_s_ = 0;
  std::array<double, robot::kTrackCount> belt_mps_{};
};

}  // namespace kenaf::engines
