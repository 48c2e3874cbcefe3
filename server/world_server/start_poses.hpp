// Where robots are placed.
#pragma once

#include <optional>
#include <string_view>

#include "physics/pose.hpp"
#include "server/world_server/simulation.hpp"

namespace kenaf::world_server {

// The start pose of that name, without case; nullptr: there is none.
const physics::StartPose* find_start_pose(const physics::WorldDescription& world, std::string_view name);
// The first start pose that is at least `clear_m` away from every robot; the first of all where none is.
const physics::StartPose& free_start_pose(const physics::World& world, double clear_m = 1.0);

// The session's robot, at rest.
void place_robot(Simulation& simulation, Session& session, const physics::RobotDescription& description,
                 const std::string& name, const physics::Pose& X_WB);

}  // namespace kenaf::world_server
