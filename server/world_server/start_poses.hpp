// Placement of robots.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "physics/pose.hpp"
#include "server/world_server/simulation.hpp"

namespace kenaf::world_server {

// Returns the world's start poses, followed by its first ones under the names that clients ask for whatever the world:
// PlayerStart, the first, and RobotStart1 to RobotStart4, unless the world has such a name itself.
std::vector<physics::StartPose> offered_start_poses(const physics::WorldDescription& world);
// Returns the offered start pose with that name, ignoring case; nullopt if there is none.
std::optional<physics::Pose> find_start_pose(const physics::WorldDescription& world, std::string_view name);
// Returns the first start pose at least `clear_m` away from every robot, or the first of all if there is none.
const physics::StartPose& free_start_pose(const physics::World& world, double clear_m = 1.0);

// Returns a robot whose place one of this description would share, or null.
const Session* robot_at(const Simulation& simulation, const physics::Pose& X_WB,
                        const physics::RobotDescription& description);

// Places the session's robot, at rest. If another robot has its name, the log and both clients that have a Session are
// told: CONTROL and the image server know robots by their names. So they are if another robot stands there: the two
// push each other apart. If it throws, neither the world nor the session has a new robot.
void place_robot(Simulation& simulation, Session& session, const physics::RobotDescription& description,
                 const std::string& name, const physics::Pose& X_WB);

}  // namespace kenaf::world_server
