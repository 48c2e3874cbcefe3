// INIT and the requests allowed before it.
#include <spdlog/spdlog.h>

#include "server/world_server/start_poses.hpp"
#include "server/world_server/verbs.hpp"
#include "server/world_server/wire_frames.hpp"

namespace kenaf::world_server {

namespace {

// nullopt: refused.
std::optional<physics::Pose> wanted_pose(const Simulation& simulation, Session& session, const MessageView& message) {
  if (const std::string_view start = text_of(message, "Start"); !start.empty()) {
    if (auto X_WB = find_start_pose(simulation.world.description(), start)) return X_WB;
    // UDK added the robot all the same, and its clients have names of its maps in their sources. A client that knows
    // this server is told by the robot's absence.
    if (session.extended) {
      complain(simulation, session, "INIT refused: no such start pose in this world; GETSTARTPOSES lists them", start);
      return std::nullopt;
    }
    complain(simulation, session, "INIT: no such start pose in this world, so another one; GETSTARTPOSES lists them",
             start);
  }
  physics::Pose X_WB = free_start_pose(simulation.world).X_WB;
  if (const auto location = read_location(message, "Location")) {
    X_WB = {*location, Eigen::Quaterniond::Identity()};
  } else if (message.find("Location")) {
    complain(simulation, session, "INIT: Location is not a place; the robot starts at a start pose",
             text_of(message, "Location"));
  }
  if (const auto rotation = read_rotation(message, "Rotation")) {
    X_WB.q = *rotation;
  } else if (message.find("Rotation")) {
    complain(simulation, session, "INIT: Rotation is not roll,pitch,yaw, so it counts as none",
             text_of(message, "Rotation"));
  }
  return X_WB;
}

// The name of the start pose that the server chooses for a client which names no place; empty: it is the first.
std::string start_if_not_first(const Simulation& simulation, const MessageView& message) {
  if (message.find("Start") || read_location(message, "Location")) return {};
  const physics::StartPose& chosen = free_start_pose(simulation.world);
  return &chosen == &simulation.world.description().start_poses.front() ? std::string() : printable(chosen.name);
}

}  // namespace

void init(Simulation& simulation, Session& session, const MessageView& message) {
  const std::string_view class_name = text_of(message, "ClassName");
  if (session.robot || session.world_controller) {
    return complain(simulation, session, "a second INIT on one connection is ignored", class_name);
  }
  if (is_any_of(class_name, {"USARBotAPI.WorldController", "WorldController"})) {
    session.world_controller = true;
    return;
  }
  if (simulation.robot_count() >= kMostRobots) {
    return complain(simulation, session, "INIT refused: 64 robots are in the world already", class_name);
  }
  const physics::RobotDescription* description = simulation.description_for_class(class_name);
  if (description == nullptr) {
    return complain(simulation, session, "INIT refused: no robot description for this class", class_name);
  }
  const auto X_WB = wanted_pose(simulation, session, message);
  if (!X_WB) return;

  std::string name = printable(text_of(message, "Name"));
  if (name.empty()) name = fmt::format("Robot{}", session.id);
  const std::string start_instead = start_if_not_first(simulation, message);
  place_robot(simulation, session, *description, name, *X_WB);
  session.robot->start_instead = start_instead;
  const std::uint64_t step = simulation.world.step_count();
  session.last_command_step = step;
  // Settings of a Session request before INIT are kept.
  session.schedule.start(step, session.schedule.period_steps(), session.schedule.numbered());
  if (!simulation.connection_log.allow(simulation.wall_s)) return;
  const Eigen::Vector3d p_WB = simulation.world.truth(session.robot->id).X_WB.p;
  spdlog::info("{}: robot {} ({}) at {:.3f}, {:.3f}, {:.3f} m", session.peer, name, description->usarsim_class,
               p_WB.x(), p_WB.y(), p_WB.z());
}

void get_start_poses(Simulation& simulation, Session& session, const MessageView&) {
  const std::vector<physics::StartPose> starts = offered_start_poses(simulation.world.description());
  const protocol::usarsim::NumberFormat format = session.formats.value;
  protocol::usarsim::MessageWriter writer(session.out);
  writer.begin("NFO").integer("StartPoses", static_cast<std::int64_t>(starts.size()));
  std::string triplets;  // UDK: every pose in one group, name location rotation
  for (const physics::StartPose& start : starts) {
    const protocol::frames::Vector3 location = wire_vector(start.X_WB.p), rotation = wire_angles(start.X_WB.q);
    if (simulation.dialect == Dialect::ut2004) {
      writer.open_group("Name", start.name)
          .add_numbers("Location", location, format)
          .add_numbers("Orientation", rotation, format)
          .close_group();
      continue;
    }
    triplets += start.name;
    for (const protocol::frames::Vector3& vector : {location, rotation}) {
      for (std::size_t i = 0; i < vector.size(); ++i) {
        triplets += i == 0 ? ' ' : ',';
        protocol::usarsim::append_number(triplets, vector[i], format);
      }
    }
    triplets += ' ';
  }
  if (!triplets.empty()) {
    triplets.pop_back();
    writer.open_group(std::string_view(triplets).substr(0, triplets.find(' ')),
                      std::string_view(triplets).substr(triplets.find(' ') + 1));
    writer.close_group();
  }
  writer.end();
}

}  // namespace kenaf::world_server
