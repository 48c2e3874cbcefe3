// Placement of robots.
#pragma once

#include <optional>
#include <string_view>

#include "physics/pose.hpp"
#include "server/world_server/simulation.hpp"

namespace kenaf::world_server {

// Returns the start pose with that name, ignoring case; nullptr if there is none.
const physics::StartPose* find_start_pose(const physics::WorldDescription& world, std::string_view name);
// Returns the first start pose at least `clear_m` away from every robot, or the first of all if there is none.
const physics::StartPose& free_start_pose(const physics::World& world, double clear_m = 1.0);

// Places the session's robot, at rest.
void place_robot(Simulation& simulation, Session& session, const physics::RobotDescription& description,
                 const std::string& name, const physics::Pose& X_WB);

}  // namespace kenaf::world_server
