#include "server/world_server/start_poses.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <utility>

#include "formats/protocol/usarsim_message.hpp"
#include "server/world_server/footprint.hpp"
#include "server/world_server/report.hpp"

namespace kenaf::world_server {

namespace {

// What clients of USARSim's maps have in their sources and launch files.
struct UsualName {
  std::string_view name;
  std::size_t index;
};
constexpr std::array kUsualNames = {UsualName{"PlayerStart", 0}, UsualName{"RobotStart1", 0},
                                    UsualName{"RobotStart2", 1}, UsualName{"RobotStart3", 2},
                                    UsualName{"RobotStart4", 3}};

auto find_by_name(const std::vector<physics::StartPose>& starts, std::string_view name) {
  return std::ranges::find_if(starts, [name](const physics::StartPose& start) {
    return protocol::usarsim::equal_ignoring_case(start.name, name);
  });
}

void warn_of_namesakes(Simulation& simulation, Session& session) {
  for (const auto& other : simulation.sessions) {
    if (other.get() == &session || !other->robot) continue;
    if (!protocol::usarsim::equal_ignoring_case(other->robot->name, session.robot->name)) continue;
    if (simulation.connection_log.allow(simulation.wall_s)) {
      spdlog::warn("{}: robot {} has the name of the robot of {}: a request by name finds one of them", session.peer,
                   session.robot->name, other->peer);
    }
    for (Session* each : {&session, other.get()}) write_warning(simulation, *each, "another robot has the same name");
    return;
  }
}

void warn_of_occupant(Simulation& simulation, Session& session, std::uint32_t occupant) {
  Session* other = simulation.find_session(occupant);
  if (other == nullptr) return;
  if (simulation.connection_log.allow(simulation.wall_s)) {
    spdlog::warn("{}: robot {} is placed where robot {} of {} stands: they push each other apart", session.peer,
                 session.robot->name, other->robot->name, other->peer);
  }
  for (Session* each : {&session, other}) write_warning(simulation, *each, "another robot is in the same place");
}

}  // namespace

std::vector<physics::StartPose> offered_start_poses(const physics::WorldDescription& world) {
  std::vector<physics::StartPose> offered = world.start_poses;
  for (const UsualName& usual : kUsualNames) {
    const bool taken = find_by_name(world.start_poses, usual.name) != world.start_poses.end();
    if (taken || usual.index >= world.start_poses.size()) continue;
    offered.push_back({std::string(usual.name), world.start_poses[usual.index].X_WB});
  }
  return offered;
}

std::optional<physics::Pose> find_start_pose(const physics::WorldDescription& world, std::string_view name) {
  const std::vector<physics::StartPose> offered = offered_start_poses(world);
  const auto found = find_by_name(offered, name);
  return found == offered.end() ? std::nullopt : std::optional(found->X_WB);
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

const Session* robot_at(const Simulation& simulation, const physics::Pose& X_WB,
                        const physics::RobotDescription& description) {
  const Eigen::Vector3d half_m = half_footprint_m(description);
  const auto found = std::ranges::find_if(simulation.sessions, [&](const auto& other) {
    return other->robot && footprints_overlap(X_WB, half_m, simulation.world.truth(other->robot->id).X_WB,
                                              half_footprint_m(*other->robot->description));
  });
  return found == simulation.sessions.end() ? nullptr : found->get();
}

void place_robot(Simulation& simulation, Session& session, const physics::RobotDescription& description,
                 const std::string& name, const physics::Pose& X_WB) {
  const Session* occupant = robot_at(simulation, X_WB, description);
  SessionRobot robot;
  robot.name = name;
  robot.description = &description;
  robot.command = Simulation::resting_command(description);
  robot.camera_field_of_view_rad = Simulation::unzoomed(description);
  robot.id = simulation.world.add_robot(description, name, X_WB);
  session.robot = std::move(robot);
  simulation.apply_command(session);
  try {
    warn_of_namesakes(simulation, session);
    if (occupant != nullptr) warn_of_occupant(simulation, session, occupant->id);
  } catch (...) {
    simulation.world.remove_robot(session.robot->id);
    session.robot.reset();
    throw;
  }
}

}  // namespace kenaf::world_server
