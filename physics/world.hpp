// The simulated world: ground, boxes and any number of tracked robots, stepped with a fixed time step.
//
// Deterministic: the same descriptions, settings, seed and calls give the same bits. Knows nothing of sockets, of
// wall-clock time or of USARSim. Frame W: x forward, y left, z up; SI units.
//
// Thread safety: none; one thread owns a World. Two Worlds share nothing and may run on two threads.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "physics/pose.hpp"
#include "physics/prescribed_motion.hpp"
#include "physics/readings.hpp"
#include "physics/robot_description.hpp"
#include "physics/world_description.hpp"
#include "physics/world_values.hpp"
#include "robot/command.hpp"

namespace kenaf::physics {

class World {
 public:
  World(const WorldDescription& description, const PhysicsSettings& settings, std::uint64_t seed);
  ~World();
  World(World&&) noexcept;
  World& operator=(World&&) noexcept;

  const WorldDescription& description() const;
  const PhysicsSettings& settings() const;
  double time_s() const;  // step_count() times the time step
  std::uint64_t step_count() const;

  // Places a robot with all joints at their start angles and at rest. A pose in which it would touch ground or box is
  // lifted straight up until it is free. `name` seeds its sensors' noise: a robot of the same name that is placed
  // again behaves the same again.
  RobotId add_robot(const RobotDescription& description, const std::string& name, const Pose& X_WB);
  void remove_robot(RobotId id);
  std::vector<RobotId> robots() const;
  const RobotDescription& robot_description(RobotId id) const;
  const std::string& robot_name(RobotId id) const;

  void set_command(RobotId id, const robot::Command& command);
  // Turns a link (from 0) of a mission package; clamped to its limits, moves with its speed limit.
  void set_mission_link(RobotId id, std::size_t package, std::size_t link, double angle_rad);
  double mission_link_rad(RobotId id, std::size_t package, std::size_t link) const;
  // Moves a robot and puts it at rest. Lifted as by add_robot. After a fault it begins anew, as add_robot places it:
  // joints, sensors and command too.
  void teleport(RobotId id, const Pose& X_WB);
  // From here on the robot moves so, where it is, as if `command` had been sent for long: command and drives are in the
  // state of turning at these speeds, and what `command` differs by from them they still have to do. What holds of
  // it the next steps decide, by friction and mass. Not for a robot with a fault.
  void set_in_motion(RobotId id, const RobotMotion& motion, const robot::Command& command);
  // In the steps to come, until told otherwise, a belt has exactly the speed and a flipper's servo exactly the angle
  // that is stated: no motor limit, no lag, no command has a part in it. Angles are directions: a flipper goes the
  // short way, at most at 10 rad/s. Play and compliance are between servo and arm, where no encoder sees them: the arm
  // has them still. A drive that is let go follows its command from the speed at that moment. Forces and currents are
  // those that the ground asks for. teleport() and reset() end it.
  void prescribe(RobotId id, const PrescribedMotion& motion);
  // Starts a sensor's integration anew: encoder counts, odometry, tachometer angle from 0; INS from its argument.
  void reset_sensor(RobotId id, std::size_t sensor, std::optional<GroundTruthReading> pose = std::nullopt);

  // One time step for everything.
  void step();
  std::size_t contact_count() const;  // contact points of the last step

  RobotTruth truth(RobotId id) const;
  DriveCurrents drive_currents(RobotId id) const;
  // What went wrong with a robot's simulation, in words; empty: nothing. Once it did, the robot is taken out of the
  // dynamics where it last was whole, until it is teleported or the world is reset: its pose is no longer a number, it
  // moves faster than anything on tracks can, or it fell out of the world. Its sensors go on to report that it stands
  // there, all finite. A loose box that it left without a pose is back at its first one.
  const std::string& fault(RobotId id) const;
  // What the sensors have to report now, in the order of the description: each sensor whose period has passed since
  // its last report by this call. Two calls without a step between give nothing the second time.
  void read_sensors(RobotId id, std::vector<SensorSample>& out);

  BoxId add_box(const Box& box);
  void move_box(BoxId id, const Pose& X_WBox);
  void remove_box(BoxId id);
  Pose box_pose(BoxId id) const;
  // Those of the description first, in its order; then as they were added.
  std::vector<BoxId> boxes() const;
  const Box& box(BoxId id) const;  // as it was described or added, wherever it is now

  // The first surface along a ray; `ignore` is a robot that the ray passes through.
  std::optional<RayHit> cast_ray(const Eigen::Vector3d& from_W, const Eigen::Vector3d& direction_W, double max_m,
                                 std::optional<RobotId> ignore = std::nullopt) const;

  // Back to time 0: every robot at the pose of its add_robot, every box at its first pose, noise from the seed again.
  void reset();

 private:
  struct Implementation;
  std::unique_ptr<Implementation> impl_;
};

}  // namespace kenaf::physics
