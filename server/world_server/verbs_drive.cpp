// DRIVE in its skid, Ackermann, body-velocity and joint forms, and MULTIDRIVE.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "formats/protocol/frames.hpp"
#include "server/world_server/joint_orders.hpp"
#include "server/world_server/verbs.hpp"

namespace kenaf::world_server {

namespace {

// A larger steering angle would be a turn on the spot.
constexpr double kSteepestSteer_rad = 1.2;

// Limit on a client's body velocity, m/s and rad/s: more than any robot reaches, and small enough for sums.
constexpr double kFastestAsked = 100;

double clamped_speed(const SessionRobot& robot, double speed_mps) {
  const double most = robot.description->drive.max_speed_mps;
  return std::clamp(speed_mps, -most, most);
}

// A wheel speed as sent by clients: rad/s, or percent of the maximum.
double surface_speed(const SessionRobot& robot, double value) {
  const physics::TrackDriveDescription& drive = robot.description->drive;
  const double speed_mps = robot.normalized ? value / 100 * drive.max_speed_mps
                                            : protocol::frames::surface_speed_from_spin(value, drive.sprocket_radius_m);
  return clamped_speed(robot, speed_mps);
}

// If one side cannot run that fast, both run slower: the robot is late, but stays on the requested curve.
void set_body_velocity(SessionRobot& robot, double linear_mps, double clockwise_radps) {
  const double turn_mps = clockwise_radps * robot.description->track_gauge_m() / 2;
  const double faster_side_mps = std::abs(linear_mps) + std::abs(turn_mps);
  const double most_mps = robot.description->drive.max_speed_mps;
  const double share = faster_side_mps > most_mps ? most_mps / faster_side_mps : 1;
  robot.command.track_speed_mps[robot::kLeft] = clamped_speed(robot, share * (linear_mps + turn_mps));
  robot.command.track_speed_mps[robot::kRight] = clamped_speed(robot, share * (linear_mps - turn_mps));
}

void drive_skid(SessionRobot& robot, const MessageView& message) {
  // A side that is not named keeps its speed.
  if (const auto left = number_of(message, "Left")) {
    robot.command.track_speed_mps[robot::kLeft] = surface_speed(robot, *left);
  }
  if (const auto right = number_of(message, "Right")) {
    robot.command.track_speed_mps[robot::kRight] = surface_speed(robot, *right);
  }
}

// The bicycle model with the tracks' contact length L as wheel base: yaw rate = v (tan front - tan rear) / L. A
// positive steering angle of USARSim turns right.
void drive_ackermann(SessionRobot& robot, const MessageView& message) {
  auto& held = robot.ackermann;
  held.speed = number_of(message, "Speed").value_or(held.speed);
  held.front_rad = number_of(message, "FrontSteer").value_or(held.front_rad);
  held.rear_rad = number_of(message, "RearSteer").value_or(held.rear_rad);
  const auto slope = [](double steer_rad) {
    return std::tan(std::clamp(steer_rad, -kSteepestSteer_rad, kSteepestSteer_rad));
  };
  const double wheel_base_m = std::max(0.01, robot.description->contact_length_m());
  const double speed_mps = surface_speed(robot, held.speed);
  set_body_velocity(robot, speed_mps, speed_mps * (slope(held.front_rad) - slope(held.rear_rad)) / wheel_base_m);
}

// The protocol's form for omnidirectional and flying robots; tracks can follow two of its four components.
void drive_body_velocity(SessionRobot& robot, const MessageView& message) {
  auto& held = robot.body_velocity;
  held.linear_mps = number_of(message, "LinearVelocity").value_or(held.linear_mps);
  held.clockwise_radps = number_of(message, "RotationalVelocity").value_or(held.clockwise_radps);
  set_body_velocity(robot, std::clamp(held.linear_mps, -kFastestAsked, kFastestAsked),
                    std::clamp(held.clockwise_radps, -kFastestAsked, kFastestAsked));
}

// What a DRIVE says of one name.
struct JointSet {
  std::string_view name;
  std::optional<JointOrder> order = JointOrder::angle;
  std::string_view value = "0";
  bool is_given = false;  // there is an order or a value
};

// A set with an unknown joint or order, or a value that is no number, is skipped. A name alone is no mistake: drivers
// of ROS name the robot itself.
void obey(Simulation& simulation, Session& session, const physics::RobotTruth& truth, const JointSet& set) {
  SessionRobot& robot = *session.robot;
  const auto flipper = find_flipper(*robot.description, set.name);
  if (!flipper || !set.order) {
    if (set.is_given) complain(simulation, session, "DRIVE: no such joint or order", set.name);
    return;
  }
  const auto value = protocol::usarsim::parse_number(set.value);
  if (!value) complain(simulation, session, fmt::format("DRIVE: Value of {} is not a number", set.name), set.value);
  if (!value && *set.order != JointOrder::brake) return;  // which needs none
  robot.command.flipper[*flipper] = joint_command(*robot.description, truth, *flipper, *set.order, value.value_or(0));
}

// {Name n} opens a set, {Order}, {Value} and {Steer} fill it; missing values are 0. Flippers do not steer.
void drive_joints(Simulation& simulation, Session& session, const MessageView& message) {
  // One truth for the whole message: relative orders of several flippers start from the same moment.
  const physics::RobotTruth truth = simulation.world.truth(session.robot->id);
  // The next Name ends a set; the end of the message ends the last one.
  JointSet set;
  for (const protocol::usarsim::Group& group : message.all()) {
    if (is_any_of(group.key, {"Name"})) {
      obey(simulation, session, truth, set);
      set = {.name = group.value};
    } else if (is_any_of(group.key, {"Order"})) {
      set.order = parse_joint_order(group.value);
      set.is_given = true;
    } else if (is_any_of(group.key, {"Value"})) {
      set.value = group.value;
      set.is_given = true;
    }
  }
  obey(simulation, session, truth, set);
}

// UT2004 righted a fallen robot by a torque. Here it is put upright where it lies.
void right_itself(Simulation& simulation, const SessionRobot& robot) {
  constexpr double kFallen = 0.7;  // cosine of the tilt
  physics::Pose X_WB = simulation.world.truth(robot.id).X_WB;
  if ((X_WB.q * Eigen::Vector3d::UnitZ()).z() > kFallen) return;
  const Eigen::Vector3d ahead = X_WB.q * Eigen::Vector3d::UnitX();
  X_WB.q = physics::rotation_from({0, 0, std::atan2(ahead.y(), ahead.x())});
  simulation.world.teleport(robot.id, X_WB);
}

void complain_of_numbers(const Simulation& simulation, Session& session, const MessageView& message) {
  for (const protocol::usarsim::Group& group : message.all()) {
    const bool numeric = is_any_of(
        group.key, {"Left", "Right", "Speed", "FrontSteer", "RearSteer", "LinearVelocity", "RotationalVelocity"});
    if (numeric && !protocol::usarsim::parse_number(group.value)) {
      complain(simulation, session, fmt::format("DRIVE: {} is not a number", group.key), group.value);
    }
  }
}

void take_command(Simulation& simulation, Session& session) {
  session.last_command_step = simulation.world.step_count();
  session.silent = false;
  if (!session.hold) simulation.apply_command(session);
}

}  // namespace

void drive(Simulation& simulation, Session& session, const MessageView& message) {
  if (!session.robot) return complain(simulation, session, kNoRobotYet, message.type);
  SessionRobot& robot = *session.robot;
  robot.normalized = bool_of(message, "Normalized").value_or(robot.normalized);
  robot.light = bool_of(message, "Light").value_or(robot.light);
  complain_of_numbers(simulation, session, message);
  if (message.find("Name")) drive_joints(simulation, session, message);
  if (message.find("Left") || message.find("Right")) {
    drive_skid(robot, message);
  } else if (message.find("Speed") || message.find("FrontSteer") || message.find("RearSteer")) {
    drive_ackermann(robot, message);
  } else if (message.find("LinearVelocity") || message.find("RotationalVelocity")) {
    drive_body_velocity(robot, message);
  }
  if (bool_of(message, "Flip").value_or(false) && !session.hold) right_itself(simulation, robot);
  take_command(simulation, session);
}

void multi_drive(Simulation& simulation, Session& session, const MessageView& message) {
  if (!session.robot) return complain(simulation, session, kNoRobotYet, message.type);
  SessionRobot& robot = *session.robot;
  if (robot.description->has_flippers()) {
    const physics::RobotTruth truth = simulation.world.truth(robot.id);
    for (const protocol::usarsim::Group& group : message.all()) {
      const auto flipper = find_flipper(*robot.description, group.key);
      if (!flipper) continue;
      const auto angle_rad = protocol::usarsim::parse_number(group.value);
      if (!angle_rad) {
        complain(simulation, session, fmt::format("MULTIDRIVE: {} is not a number", group.key), group.value);
        continue;
      }
      robot.command.flipper[*flipper] =
          joint_command(*robot.description, truth, *flipper, JointOrder::angle, *angle_rad);
    }
  }
  take_command(simulation, session);
}

}  // namespace kenaf::world_server
