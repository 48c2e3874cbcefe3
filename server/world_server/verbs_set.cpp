// SET in both dialects, and the camera mounts of MISPKG and ACT.
#include <algorithm>
#include <cmath>

#include "server/world_server/encoder_names.hpp"
#include "server/world_server/joint_orders.hpp"
#include "server/world_server/verbs.hpp"
#include "server/world_server/wire_frames.hpp"

namespace kenaf::world_server {

namespace {

Reason set_joint(Simulation& simulation, Session& session, const MessageView& message) {
  SessionRobot& robot = *session.robot;
  if (!robot.description->has_flippers()) return "this robot has no joints";
  const auto order = parse_joint_order(text_of(message, "Opcode"));
  if (!order) return "unknown Opcode";
  std::array<double, robot::kFlipperCount> params{};
  const auto count = protocol::usarsim::parse_number_list(text_of(message, "Params"), params);
  const bool brakes = *order == JointOrder::brake;  // which needs no number
  if (!brakes && (!count || *count == 0)) return "Params is not a number";

  const std::string_view name = text_of(message, "Name");
  const physics::RobotTruth truth = simulation.world.truth(robot.id);
  const auto command = [&](robot::Flipper flipper, double value) {
    robot.command.flipper[flipper] = joint_command(*robot.description, truth, flipper, *order, value);
  };
  if (is_any_of(name, {"AllJoints", "AllAngles"})) {
    // One value for all, or one for each. Another number of them is a mistake, such as a decimal comma.
    if (!brakes && count != 1 && count != kUsarsimJoints.size()) return "Params is neither one number nor four";
    for (std::size_t i = 0; i < kUsarsimJoints.size(); ++i) {
      if (robot.description->has(kUsarsimJoints[i])) command(kUsarsimJoints[i], count == 1 ? params[0] : params[i]);
    }
  } else if (const auto flipper = find_flipper(*robot.description, name)) {
    command(*flipper, params[0]);
  } else {
    return "no joint of that name";
  }
  if (!session.hold) simulation.apply_command(session);
  return kDone;
}

// Applies `what` to every sensor of the type and, if given, of the name.
template <typename What>
Reason for_sensors(const SessionRobot& robot, std::string_view type, std::string_view name, What what) {
  Reason reason = "no such sensor on this robot";
  for (std::size_t i = 0; i < robot.description->sensors.size(); ++i) {
    const physics::SensorDescription& sensor = robot.description->sensors[i];
    if (!protocol::usarsim::equal_ignoring_case(physics::usarsim_type_name(sensor.type), type)) continue;
    if (!name.empty() && !protocol::usarsim::equal_ignoring_case(sensor.name, name)) continue;
    what(i);
    reason = kDone;
  }
  return reason;
}

Reason reset_sensors(Simulation& simulation, const SessionRobot& robot, std::string_view type, std::string_view name) {
  // The side that is named, or both without a name.
  if (is_any_of(type, {"Encoder"})) {
    for (const robot::Track side : {robot::kLeft, robot::kRight}) {
      if (!protocol::usarsim::equal_ignoring_case(name, kEncoderNames[side])) continue;
      return for_sensors(robot, type, {},
                         [&](std::size_t i) { simulation.world.reset_track_sensor(robot.id, i, side); });
    }
  }
  return for_sensors(robot, type, name, [&](std::size_t i) { simulation.world.reset_sensor(robot.id, i); });
}

Reason set_ins(Simulation& simulation, const SessionRobot& robot, const MessageView& message) {
  if (!is_any_of(text_of(message, "Opcode"), {"POSE"})) return "unknown Opcode";
  std::array<double, 6> params;
  if (!protocol::usarsim::parse_numbers(text_of(message, "Params"), params) ||
      std::ranges::any_of(params, [](double value) { return std::abs(value) > 1e5; })) {
    return "Params is not x,y,z,roll,pitch,yaw";
  }
  const physics::GroundTruthReading pose{
      vector_from(protocol::frames::rep103_vector_from_usarsim({params[0], params[1], params[2]})),
      vector_from(protocol::frames::rep103_angles_from_usarsim({params[3], params[4], params[5]}))};
  return for_sensors(robot, "INS", text_of(message, "Name"),
                     [&](std::size_t i) { simulation.world.reset_sensor(robot.id, i, pose); });
}

// Applies to all cameras if none is named, as with sensors.
Reason set_camera(SessionRobot& robot, const MessageView& message) {
  const auto field_of_view = number_of(message, "Params");
  if (!is_any_of(text_of(message, "Opcode"), {"Zoom", "FOV"})) return "unknown Opcode";
  if (!field_of_view || !(*field_of_view > 0 && *field_of_view < 3.15))
    return "Params is not an angle of view in radians";
  const std::string_view name = text_of(message, "Name");
  Reason reason = "no such camera on this robot";
  const auto& cameras = robot.description->cameras;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    if (!name.empty() && !protocol::usarsim::equal_ignoring_case(cameras[i].name, name)) continue;
    robot.camera_field_of_view_rad[i] =
        std::clamp(*field_of_view, cameras[i].min_field_of_view_rad, cameras[i].max_field_of_view_rad);
    reason = kDone;
  }
  return reason;
}

Reason obey_set(Simulation& simulation, Session& session, const MessageView& message) {
  if (!session.robot) return "no robot";
  SessionRobot& robot = *session.robot;
  const std::string_view type = text_of(message, "Type"), opcode = text_of(message, "Opcode");
  if (is_any_of(type, {"Joint"})) return set_joint(simulation, session, message);
  if (is_any_of(type, {"Odometry", "Encoder", "Tachometer"})) {
    if (!is_any_of(opcode, {"RESET"})) return "unknown Opcode";
    return reset_sensors(simulation, robot, type, text_of(message, "Name"));
  }
  if (is_any_of(type, {"INS"})) return set_ins(simulation, robot, message);
  if (is_any_of(type, {"RangeScanner"})) {
    // The scanners here scan automatically; the next scan comes when it is due.
    if (!is_any_of(opcode, {"SCAN"})) return "unknown Opcode";
    return for_sensors(robot, type, text_of(message, "Name"), [](std::size_t) {});
  }
  if (is_any_of(type, {"Camera"})) return session.hold ? kDone : set_camera(robot, message);
  if (is_any_of(type, {"Viewports"})) return "a picture is one camera's: the image server's clients choose it";
  return "unknown Type";
}

}  // namespace

void set(Simulation& simulation, Session& session, const MessageView& message) {
  const Reason reason = obey_set(simulation, session, message);
  if (simulation.dialect == Dialect::ut2004) {
    answer(simulation, session, text_of(message, "Type"), text_of(message, "Name"), reason);
  } else if (!reason.empty()) {
    complain(simulation, session, reason, message.type);
  }
}

void move_mission_package(Simulation& simulation, Session& session, const MessageView& message) {
  if (!session.robot) return complain(simulation, session, kNoRobotYet, message.type);
  if (session.hold) return;
  const SessionRobot& robot = *session.robot;
  const auto& packages = robot.description->mission_packages;
  const auto package = std::ranges::find_if(packages, [&](const physics::MissionPackageDescription& candidate) {
    return protocol::usarsim::equal_ignoring_case(candidate.name, text_of(message, "Name"));
  });
  if (package == packages.end()) {
    return complain(simulation, session, "no such mission package on this robot", text_of(message, "Name"));
  }
  const auto package_index = static_cast<std::size_t>(package - packages.begin());

  // {Link i} starts a set, {Value} and {Order} fill it. A set with anything that cannot be read is skipped.
  struct LinkSet {
    std::optional<std::string_view> link;
    std::string_view value = "0";
    std::optional<JointOrder> order = JointOrder::angle;
  } set;
  const auto finish = [&] {
    if (!set.link) return;
    const auto link = protocol::usarsim::parse_number(*set.link);
    const auto order = set.order;
    if (!order || !link || !(*link >= 1 && *link <= static_cast<double>(package->links.size())))
      return complain(simulation, session, "MISPKG: no such link or order", *set.link);
    const auto value = protocol::usarsim::parse_number(set.value);
    if (!value) return complain(simulation, session, "MISPKG: Value is not a number", set.value);
    const auto index = static_cast<std::size_t>(*link) - 1;
    const double now_rad = simulation.world.mission_link_rad(robot.id, package_index, index);
    const double wanted_rad = protocol::frames::rep103_link_from_usarsim(*value);
    double angle_rad = now_rad;  // brake, and orders that a camera mount cannot execute
    if (*order == JointOrder::angle) angle_rad = wanted_rad;
    if (*order == JointOrder::relative_angle) angle_rad = now_rad + wanted_rad;
    if (*order == JointOrder::speed && wanted_rad > 0) angle_rad = package->links[index].max_rad;
    if (*order == JointOrder::speed && wanted_rad < 0) angle_rad = package->links[index].min_rad;
    simulation.world.set_mission_link(robot.id, package_index, index, angle_rad);
  };
  for (const protocol::usarsim::Group& group : message.all()) {
    if (is_any_of(group.key, {"Link"})) {
      finish();
      set = {.link = group.value};
    } else if (is_any_of(group.key, {"Value"})) {
      set.value = group.value;
    } else if (is_any_of(group.key, {"Order"})) {
      set.order = parse_joint_order(group.value);
    }
  }
  finish();
}

}  // namespace kenaf::world_server
