// The simulated world: ground, boxes and any number of tracked robots, stepped with a fixed time step.
//
// Deterministic: the same descriptions, settings, seed and calls give the same bits. Independent of sockets, wall-clock
// time and USARSim. World frame W: z up, x and y as in the world file. Body frame B: origin at the body's geometric
// centre, x forward, y left, z up. SI units.
//
// A function that takes the id of a robot or box throws std::out_of_range if this world has none of that id, except
// cast_ray, which then ignores no robot.
//
// Thread safety: none; one thread owns a World. Two Worlds share nothing and may run on two threads.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "physics/contact_point.hpp"
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

  // Places a robot at rest with all joints at their start angles. If it would touch ground or a box, it is lifted
  // straight up until it is free. `name` seeds its sensors' noise: another robot placed with the same name behaves the
  // same. Throws std::invalid_argument if the pose is not finite or more than 1000 km from W's origin; from 100 km on
  // the robot has a fault at once, see fault().
  RobotId add_robot(const RobotDescription& description, const std::string& name, const Pose& X_WB);
  void remove_robot(RobotId id);
  std::vector<RobotId> robots() const;
  const RobotDescription& robot_description(RobotId id) const;
  const std::string& robot_name(RobotId id) const;

  // In force from the next step on. Values that are not finite leave the ones set before.
  void set_command(RobotId id, const robot::Command& command);
  // A mission package is a camera mount with links that turn (USARSim's word). Turns link `link` of package `package`,
  // both counted from 0 in the order of the description, within its limits of angle and speed. Throws
  // std::out_of_range if there is none.
  void set_mission_link(RobotId id, std::size_t package, std::size_t link, double angle_rad);
  double mission_link_rad(RobotId id, std::size_t package, std::size_t link) const;
  // Moves a robot and puts it at rest; lifts it as add_robot does. After a fault, the robot starts afresh as from
  // add_robot, including joints, sensors and command. Throws as add_robot does.
  void teleport(RobotId id, const Pose& X_WB);
  // Sets the robot in motion where it is, as if `command` had been sent for long: drives turn at these speeds, and
  // follow `command` from there. Friction and mass decide in the next steps how the motion continues. Does nothing for
  // a robot with a fault. Throws std::invalid_argument if a value is not finite.
  void set_in_motion(RobotId id, const RobotMotion& motion, const robot::Command& command);
  // From the next step on, until changed, belts have exactly the stated speeds, and flippers' servos turn to the stated
  // angles, regardless of motor limits, lags and commands. Angles are directions: a servo goes the short way, at most
  // at 10 rad/s, and is there at the end of the step if that suffices. Play and compliance, between servo and arm,
  // still act on the arm. A drive that is released follows its command from its speed at that moment. Forces and
  // currents are those that the motion requires. teleport() and reset() end it. Throws std::invalid_argument if a value
  // is not finite.
  void prescribe(RobotId id, const PrescribedMotion& motion);
  // Adds instruments to a robot: the sensors of `description` report what they would on a robot of that description if
  // it moved like this one. So its effects on sensors count, and what sensors measure by, as the sprocket's radius and
  // the resolution of encoders and servos; nothing else of it does. Returns their number: 1 for the first, as the
  // robot's own sensors are number 0. They stay until the robot is removed.
  std::size_t add_instruments(RobotId id, const RobotDescription& description);
  // Restarts the integration of a sensor, an index into the description's sensors: encoder counts, odometry and
  // tachometer angle at 0, INS at `pose`; without `pose` the INS reports the robot's true pose again. Throws
  // std::out_of_range if there are no such sensor or instruments.
  void reset_sensor(RobotId id, std::size_t sensor, const std::optional<GroundTruthReading>& pose = {},
                    std::size_t instruments = 0);
  // The same for one side of the robot's own encoder or tachometer; the other one counts on.
  void reset_track_sensor(RobotId id, std::size_t sensor, robot::Track side);

  // Advances everything by one time step.
  void step();
  std::size_t contact_count() const;  // contact points of the last step
  // Replaces `out` with the points where the robot was pressed upon in the last step; the forces are means over that
  // step. None before the first step, and after teleport(). A point between two robots is in the lists of both, with
  // opposite forces. The sum of a robot's forces is its mass times the acceleration of its centre of mass less gravity.
  // Read from the solver when called: a step does nothing for it. Allocates only if `out` lacks room.
  void contacts(RobotId id, std::vector<ContactPoint>& out) const;
  // Pairs of bodies near each other: what a step's time grows with. Beyond kMostPairs, boxes meet nothing but the
  // ground; pairs_left_out() counts how often that happened so far.
  std::size_t pair_count() const;
  std::uint64_t pairs_left_out() const;

  RobotTruth truth(RobotId id) const;
  DriveCurrents drive_currents(RobotId id) const;
  // Describes what went wrong with a robot's simulation; empty if nothing did. A fault is a pose that is not finite, a
  // speed beyond anything on tracks, or a place out of the world: 100 m below z = 0, or 100 km from the origin. The
  // robot is then taken out of the dynamics at its last valid pose until it is teleported or the world is reset; its
  // sensors report, in finite numbers, that it stands there. A loose box whose pose the robot has made invalid returns
  // to its initial pose.
  const std::string& fault(RobotId id) const;
  // Appends to `out` the readings that are due, in the order of the description: those of each sensor whose period has
  // passed since its last report by this call. A second call without a step between appends nothing. Throws
  // std::out_of_range if there are no such instruments.
  void read_sensors(RobotId id, std::vector<SensorSample>& out, std::size_t instruments = 0);

  // Both throw std::invalid_argument as add_robot does; add_box also for a size, mass or friction out of range.
  BoxId add_box(const Box& box);
  void move_box(BoxId id, const Pose& X_WBox);
  void remove_box(BoxId id);
  Pose box_pose(BoxId id) const;
  // The description's boxes in its order, then the others in the order in which they were added.
  std::vector<BoxId> boxes() const;
  const Box& box(BoxId id) const;  // as described or added, with its initial pose

  // How many boxes, without `except`, would overlap a box of this size and place: those whose extents along W's axes
  // overlap its own, at their present pose or at their initial one, to which reset() returns them.
  std::size_t overlapping_boxes(const Eigen::Vector3d& size_m, const Pose& X_WBox,
                                std::optional<BoxId> except = std::nullopt) const;

  // The first surface along a ray; `ignore` is a robot that the ray passes through.
  std::optional<RayHit> cast_ray(const Eigen::Vector3d& from_W, const Eigen::Vector3d& direction_W, double max_m,
                                 std::optional<RobotId> ignore = std::nullopt) const;

  // Back to time 0: every robot at the pose of its add_robot, every box at its initial pose, noise from the seed again.
  void reset();

 private:
  struct Implementation;
  std::unique_ptr<Implementation> impl_;
};

}  // namespace kenaf::physics
