#include "server/world_server/start_poses.hpp"

#include <algorithm>

#include "formats/protocol/usarsim_message.hpp"

namespace kenaf::world_server {

const physics::StartPose* find_start_pose(const physics::WorldDescription& world, std::string_view name) {
  const auto found = std::ranges::find_if(world.start_poses, [name](const physics::StartPose& start) {
    return protocol::usarsim::equal_ignoring_case(start.name, name);
  });
  return found == world.start_poses.end() ? nullptr : &*found;
}

const physics::StartPose& free_start_pose(const physics::World& world, double clear_m) {
  const auto& starts = world.description().start_poses;
  const auto robots = world.robots();
  const auto found = std::ranges::find_if(starts, [&](const physics::StartPose& start) {
    return std::ranges::none_of(
        robots, [&](physics::RobotId id) { return (world.truth(id).X_WB.p - start.X_WB.p).norm() < clear_m; });
  });
  return found == starts.end() ? starts.front() : *found;
}

void place_robot(Simulation& simulation, Session& session, const physics::RobotDescription& description,
                 const std::string& name, const physics::Pose& X_WB) {
  const physics::RobotId id = simulation.world.add_robot(description, name, X_WB);
  SessionRobot& robot = session.robot.emplace();
  robot.id = id;
  robot.name = name;
  robot.description = &description;
  robot.command = Simulation::resting_command(description);
  robot.camera_field_of_view_rad = Simulation::unzoomed(description);
  simulation.apply_command(session);
}

}  // namespace kenaf::world_server
