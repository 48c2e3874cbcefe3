#include "server/world_server/manual_drive.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>

#include "physics/robot_dimensions.hpp"
#include "server/world_server/start_poses.hpp"

namespace kenaf::world_server {

namespace {

constexpr std::string_view kNoRobot = "that robot is no longer in the world";
constexpr std::string_view kNotHeld = "you do not hold that robot: take it over first";

Session* session_with_robot(Simulation& simulation, std::uint32_t id) {
  Session* session = simulation.find_session(id);
  return session != nullptr && session->robot ? session : nullptr;
}

bool held_by(const Session& session, OperatorId who) {
  return session.hold && session.hold->holder == who;
}

void release(Simulation& simulation, Session& session) {
  session.hold.reset();
  session.robot->command = standing_command();
  forget_curve(*session.robot);
  simulation.apply_command(session);
  spdlog::info("robot {} is no longer driven by hand", session.robot->name);
}

physics::Pose pose_over(const GroundPlace& where, const physics::RobotDescription& description) {
  const Eigen::Vector3d up(0, 0, physics::dimensions_of(description).ride_height_m);
  return {where.p_W + up, physics::rotation_from({0, 0, where.yaw_rad})};
}

robot::Command within_limits(const physics::RobotDescription& robot, robot::Command command) {
  for (double& speed : command.track_speed_mps) {
    speed = std::clamp(speed, -robot.drive.max_speed_mps, robot.drive.max_speed_mps);
  }
  for (std::size_t i = 0; i < robot::kFlipperCount; ++i) {
    robot::JointCommand& joint = command.flipper[i];
    if (!robot.has(static_cast<robot::Flipper>(i))) {
      joint = {robot::JointMode::brake, 0};
    } else if (joint.mode == robot::JointMode::angle) {
      joint.value = std::clamp(joint.value, robot.flipper.front().min_angle_rad, robot.flipper.front().max_angle_rad);
    } else if (joint.mode == robot::JointMode::speed) {
      joint.value = std::clamp(joint.value, -robot.servo.max_speed_radps, robot.servo.max_speed_radps);
    }
  }
  return command;
}

}  // namespace

robot::Command standing_command() {
  robot::Command command;
  command.flipper.fill({robot::JointMode::brake, 0});
  return command;
}

std::string_view take_robot(Simulation& simulation, std::uint32_t id, OperatorId who) {
  Session* session = session_with_robot(simulation, id);
  if (session == nullptr) return kNoRobot;
  if (held_by(*session, who)) return {};
  if (session->hold) return "another operator holds that robot";
  session->hold = ManualHold{who, standing_command(), simulation.wall_s};
  simulation.apply_command(*session);
  spdlog::info("robot {} is driven by hand", session->robot->name);
  return {};
}

const physics::RobotDescription* robot_to_place(Simulation& simulation) {
  return simulation.description_for_class("USARBot.Kenaf");
}

std::string_view place_robot_by_hand(Simulation& simulation, OperatorId who, std::uint32_t& id,
                                     const std::optional<GroundPlace>& where) {
  const auto placed = std::ranges::count_if(simulation.sessions, [](const auto& s) { return s->placed_by_operator; });
  if (static_cast<std::size_t>(placed) >= kMostPlacedRobots)
    return "operators have already placed 8 robots: remove one first";
  if (simulation.robot_count() >= kMostRobots) return "there are already 64 robots in the world";
  const physics::RobotDescription* description = robot_to_place(simulation);
  if (description == nullptr) return "there is no description of USARBot.Kenaf";
  if (where && robot_at(simulation, pose_over(*where, *description), *description) != nullptr)
    return "another robot stands there";
  Session& session = simulation.connect("an operator");
  session.placed_by_operator = true;
  try {
    place_robot(simulation, session, *description, fmt::format("Manual{}", session.id),
                where ? pose_over(*where, *description) : free_start_pose(simulation.world).X_WB);
  } catch (...) {
    simulation.disconnect(session);
    throw;
  }
  id = session.id;
  return take_robot(simulation, id, who);
}

std::string_view drive_by_hand(Simulation& simulation, std::uint32_t id, OperatorId who,
                               const robot::Command& command) {
  Session* session = session_with_robot(simulation, id);
  if (session == nullptr) return kNoRobot;
  if (!held_by(*session, who)) return kNotHeld;
  session->hold->command = within_limits(*session->robot->description, command);
  session->hold->last_word_wall_s = simulation.wall_s;
  session->hold->silent = false;
  session->hold->stop.over();
  simulation.apply_command(*session);
  return {};
}

std::string_view look_by_hand(Simulation& simulation, std::uint32_t id, OperatorId who, std::string_view name,
                              const CameraOrder& order) {
  Session* session = session_with_robot(simulation, id);
  if (session == nullptr) return kNoRobot;
  if (!held_by(*session, who)) return kNotHeld;
  SessionRobot& robot = *session->robot;
  const auto& cameras = robot.description->cameras;
  const auto camera = std::ranges::find(cameras, name, &physics::CameraDescription::name);
  if (camera == cameras.end()) return "that robot has no such camera";
  const std::size_t links =
      camera->mission_package ? robot.description->mission_packages[*camera->mission_package].links.size() : 0;
  if ((order.pan_rad && links < 1) || (order.tilt_rad && links < 2)) return "that camera does not turn about this axis";
  if (order.pan_rad) simulation.world.set_mission_link(robot.id, *camera->mission_package, 0, *order.pan_rad);
  if (order.tilt_rad) simulation.world.set_mission_link(robot.id, *camera->mission_package, 1, *order.tilt_rad);
  if (order.field_of_view_rad) {
    robot.camera_field_of_view_rad[static_cast<std::size_t>(camera - cameras.begin())] =
        std::clamp(*order.field_of_view_rad, camera->min_field_of_view_rad, camera->max_field_of_view_rad);
  }
  return {};
}

std::string_view let_go(Simulation& simulation, std::uint32_t id, OperatorId who) {
  Session* session = session_with_robot(simulation, id);
  if (session == nullptr) return kNoRobot;
  if (!held_by(*session, who)) return kNotHeld;
  release(simulation, *session);
  return {};
}

std::string_view remove_placed_robot(Simulation& simulation, std::uint32_t id, OperatorId who) {
  Session* session = session_with_robot(simulation, id);
  if (session == nullptr) return kNoRobot;
  if (!session->placed_by_operator) return "that robot belongs to a client, and leaves with it";
  if (session->hold && !held_by(*session, who)) return "another operator holds that robot";
  simulation.disconnect(*session);
  return {};
}

void let_go_of_all(Simulation& simulation, OperatorId who) {
  for (const auto& session : simulation.sessions) {
    if (session->robot && held_by(*session, who)) release(simulation, *session);
  }
}

void watch_operator(Simulation& simulation, Session& session) {
  if (!session.hold) return;
  ManualHold& hold = *session.hold;
  if (!hold.silent && simulation.wall_s < hold.last_word_wall_s + kOperatorSilence_s) return;
  hold.silent = true;
  hold.command = standing_command();
  if (hold.stop.due(simulation.world.step_count())) simulation.apply_command(session);
}

}  // namespace kenaf::world_server
