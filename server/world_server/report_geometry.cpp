// GETGEO and GETCONF: mounting positions and abilities. Always answered: a type that the robot does not have is echoed,
// as by UT2004; UDK did not answer.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "server/world_server/encoder_names.hpp"
#include "server/world_server/joint_orders.hpp"
#include "server/world_server/scan_angles.hpp"
#include "server/world_server/verbs.hpp"
#include "server/world_server/wire_frames.hpp"

namespace kenaf::world_server {

namespace {

using physics::SensorDescription;
using physics::SensorType;
using protocol::usarsim::MessageWriter;

struct Request {
  std::string type, name;  // name: "" = all
  bool geometry;           // GEO, not CONF
};

std::string_view short_class_name(const physics::RobotDescription& robot) {
  const std::string_view name = robot.usarsim_class;
  return name.substr(name.rfind('.') + 1);  // npos + 1 is 0
}

// Dimensions without the flippers, which move.
protocol::frames::Vector3 dimensions_m(const physics::RobotDescription& robot) {
  double top_m = robot.body.size_m.z() / 2, bottom_m = -top_m;
  for (const physics::TrackDescription& track : robot.track) {
    top_m = std::max(top_m, track.p_BT_m.z() + track.end_radius_m);
    bottom_m = std::min(bottom_m, track.p_BT_m.z() - track.end_radius_m);
  }
  return {std::max(robot.body.size_m.x(), robot.track_length_m()),
          std::max(robot.body.size_m.y(), robot.outer_width_m()), top_m - bottom_m};
}

void write_robot_geometry(MessageWriter& writer, const physics::RobotDescription& robot,
                          protocol::usarsim::NumberFormat format) {
  writer.begin("GEO")
      .text("Type", "GroundVehicle")
      .text("Name", short_class_name(robot))
      .numbers("Dimensions", dimensions_m(robot), format)
      .numbers("COG", wire_vector(robot.body.p_BBcm_m), format)
      .number("WheelRadius", robot.drive.sprocket_radius_m, format)
      .number("WheelSeparation", robot.track_gauge_m(), format)
      .number("WheelBase", robot.contact_length_m(), format)
      .end();
}

// MaxSpeed is the spin of the driven wheel in rad/s, with which clients scale DRIVE.
void write_robot_configuration(MessageWriter& writer, const physics::RobotDescription& robot, Dialect dialect,
                               protocol::usarsim::NumberFormat format) {
  writer.begin("CONF");
  if (dialect == Dialect::ut2004) writer.text("Type", "GroundVehicle").text("Name", short_class_name(robot));
  if (dialect == Dialect::udk) writer.text("Name", short_class_name(robot)).text("Type", "GroundVehicle");
  const double radius_m = robot.drive.sprocket_radius_m;
  writer.text("SteeringType", "SkidSteered")
      .number("Mass", robot.total_mass_kg(), format)
      .number("MaxSpeed", protocol::frames::spin_from_surface_speed(robot.drive.max_speed_mps, radius_m), format)
      .number("MaxTorque", robot.drive.max_force_n * radius_m, format)
      .integer("MaxFrontSteer", 0)
      .integer("MaxRearSteer", 0)
      .end();
}

// `mount`: the part that turns it; empty: fixed on the robot.
void add_mount(MessageWriter& writer, Dialect dialect, std::string_view name, const physics::Pose& X_B,
               const physics::RobotDescription& robot, protocol::usarsim::NumberFormat format,
               std::string_view mount = {}) {
  const protocol::frames::Vector3 location = wire_vector(X_B.p), orientation = wire_angles(X_B.q);
  if (dialect == Dialect::ut2004) {
    writer.open_group("Name", name)
        .add_numbers("Location", location, format)
        .add_numbers("Orientation", orientation, format)
        .add_text("Mount", mount.empty() ? "HARD" : mount)
        .close_group();
    return;
  }
  writer.text("Name", name)
      .numbers("Location", location, format)
      .numbers("Orientation", orientation, format)
      .text("Mount", mount.empty() ? short_class_name(robot) : mount);
}

void add_configuration(MessageWriter& writer, const SensorDescription& sensor, double ticks_per_radian,
                       std::string_view name, const Formats& formats) {
  const protocol::usarsim::NumberFormat format = formats.value;
  writer.text("Name", name).number("ScanInterval", sensor.period_s, format);
  switch (sensor.type) {
    case SensorType::encoder:
      writer.number("Resolution", 1 / ticks_per_radian, format);
      break;
    case SensorType::sonar:
      writer.number("MaxRange", sensor.max_range_m, format)
          .number("MinRange", sensor.min_range_m, format)
          .number("BeamAngle", sensor.field_of_view_rad, format);
      break;
    case SensorType::range_scanner: {
      const ScanAngles angles = scan_angles(sensor, formats.scan_angle);
      writer.number("MaxRange", sensor.max_range_m, format)
          .number("MinRange", sensor.min_range_m, format)
          .number("Resolution", angles.resolution_rad, angles.format)
          .number("Fov", angles.field_of_view_rad, angles.format)
          .boolean("Panning", true)
          .boolean("Tilting", false);
      break;
    }
    default:
      break;
  }
}

bool write_sensors(MessageWriter& writer, const Simulation& simulation, const Session& session,
                   const Request& request) {
  const physics::RobotDescription& robot = *session.robot->description;
  const protocol::usarsim::NumberFormat format = session.formats.value;
  bool found = false;
  for (const SensorDescription& sensor : robot.sensors) {
    if (!protocol::usarsim::equal_ignoring_case(physics::usarsim_type_name(sensor.type), request.type)) continue;
    const bool encoder = sensor.type == SensorType::encoder;
    // An encoder sensor is listed by its two sides.
    for (const std::string_view side : kEncoderNames) {
      const std::string_view name = encoder ? side : std::string_view(sensor.name);
      if (!request.name.empty() && !protocol::usarsim::equal_ignoring_case(name, request.name)) continue;
      if (!found) writer.begin(request.geometry ? "GEO" : "CONF").text("Type", request.type);
      found = true;
      if (request.geometry) {
        add_mount(writer, simulation.dialect, name, sensor.X_BS, robot, format);
      } else {
        add_configuration(writer, sensor, robot.drive.encoder_counts_per_radian, name, session.formats);
      }
      if (!encoder) break;
    }
  }
  if (found) writer.end();
  return found;
}

// A link turns about the z axis of its frame, in USARSim's axes; its parent is the link before it. Link 1 pans about
// the mount's z. Link 2 tilts, positive up, about the y axis of link 1, which a roll of -90 degrees makes its z. No
// camera has more.
physics::Pose link_in_parent(const physics::Pose& X_BM, std::size_t link, bool from_mount) {
  if (link == 0) return from_mount ? physics::Pose{} : X_BM;
  return link == 1 ? physics::Pose{Eigen::Vector3d::Zero(), physics::rotation_from({-std::numbers::pi / 2, 0, 0})}
                   : physics::Pose{};
}

// `actuator`: in the form of UDK's actuators, which have a mount of their own and name the parent otherwise.
void add_link_geometry(MessageWriter& writer, const physics::MissionPackageDescription& package, std::size_t link,
                       bool actuator, protocol::usarsim::NumberFormat format) {
  const physics::Pose X_PL = link_in_parent(package.X_BM, link, actuator);
  const auto parent = static_cast<std::int64_t>(link);
  if (actuator) writer.integer("Parent", parent);
  if (!actuator) writer.integer("ParentLink", link == 0 ? -1 : parent);
  writer.numbers("Location", wire_vector(X_PL.p), format).numbers("Orientation", wire_angles(X_PL.q), format);
}

// The sign of the angle differs from USARSim's, so minimum and maximum change places.
void add_link_configuration(MessageWriter& writer, const physics::MissionPackageDescription::Link& link, bool actuator,
                            protocol::usarsim::NumberFormat format) {
  writer.text("JointType", "Revolute")
      .number("MaxSpeed", link.max_speed_radps, format)
      .number("MaxTorque", 0, format)
      .number(actuator ? "MinValue" : "MinRange", protocol::frames::usarsim_link_from_rep103(link.max_rad), format)
      .number(actuator ? "MaxValue" : "MaxRange", protocol::frames::usarsim_link_from_rep103(link.min_rad), format);
}

// {Type MisPkg} as of UT2004, {Type Actuator} as of UDK. One line for each package, as clients of UT2004 read them.
bool write_mission_packages(MessageWriter& writer, const Session& session, const Request& request) {
  const physics::RobotDescription& robot = *session.robot->description;
  const protocol::usarsim::NumberFormat format = session.formats.value;
  const bool actuator = is_any_of(request.type, {"Actuator"});
  bool found = false;
  for (const physics::MissionPackageDescription& package : robot.mission_packages) {
    if (!request.name.empty() && !protocol::usarsim::equal_ignoring_case(package.name, request.name)) continue;
    found = true;
    writer.begin(request.geometry ? "GEO" : "CONF").text("Type", request.type);
    if (request.geometry && actuator) {
      add_mount(writer, Dialect::udk, package.name, package.X_BM, robot, format);
    } else {
      writer.text("Name", package.name);
    }
    for (std::size_t link = 0; link < package.links.size(); ++link) {
      writer.integer("Link", static_cast<std::int64_t>(link) + 1);
      if (request.geometry) add_link_geometry(writer, package, link, actuator, format);
      if (!request.geometry) add_link_configuration(writer, package.links[link], actuator, format);
    }
    // Of the last link: what is mounted sits in its origin.
    if (request.geometry) writer.numbers("Tip", protocol::frames::Vector3{}, format);
    writer.end();
  }
  return found;
}

// {Type Joint}: USARSim has no request for flipper positions, so this one is specific to this server.
bool write_flippers(MessageWriter& writer, const Session& session, const Request& request) {
  const physics::RobotDescription& robot = *session.robot->description;
  if (!robot.has_flippers()) return false;
  const physics::FlipperDescription& flipper = robot.flipper.front();

  // One message for all flippers that match; none if no name matches.
  const protocol::usarsim::NumberFormat format = session.formats.value;
  bool found = false;
  for (std::size_t i = 0; i < robot::kFlipperCount; ++i) {
    const auto which = static_cast<robot::Flipper>(i);
    const char* name = protocol::frames::usarsim_flipper_name(which);
    if (!robot.has(which)) continue;
    if (!request.name.empty() && !protocol::usarsim::equal_ignoring_case(name, request.name)) continue;
    if (!found) writer.begin(request.geometry ? "GEO" : "CONF").text("Type", request.type);
    found = true;
    writer.text("Name", name);
    if (request.geometry) {
      // The description has the front left flipper's pivot; the others are its mirror images in the planes x = 0 and y
      // = 0.
      const bool rear = which == robot::kRearLeft || which == robot::kRearRight;
      const bool right = which == robot::kFrontRight || which == robot::kRearRight;
      const Eigen::Vector3d mirror(rear ? -1 : 1, right ? -1 : 1, 1);
      writer.numbers("Location", wire_vector(flipper.p_BPivot_m.cwiseProduct(mirror)), format)
          .number("Length", flipper.length_m, format);
    } else {
      // USARSim's angle may run the other way, so the converted limits are put in order.
      const double a = protocol::frames::usarsim_flipper_from_tip_up(which, flipper.min_angle_rad);
      const double b = protocol::frames::usarsim_flipper_from_tip_up(which, flipper.max_angle_rad);
      writer.text("JointType", "Revolute")
          .number("MaxSpeed", robot.servo.max_speed_radps, format)
          .number("MaxTorque", robot.servo.max_torque_nm, format)
          .number("MinValue", std::min(a, b), format)
          .number("MaxValue", std::max(a, b), format);
    }
  }
  if (found) writer.end();
  return found;
}

// A camera turned by a package is reported at its position with the package's links at 0.
bool write_cameras(MessageWriter& writer, const Simulation& simulation, const Session& session,
                   const Request& request) {
  const physics::RobotDescription& robot = *session.robot->description;

  // One message for all cameras that match; none if no name matches.
  const protocol::usarsim::NumberFormat format = session.formats.value;
  bool found = false;
  for (std::size_t i = 0; i < robot.cameras.size(); ++i) {
    const physics::CameraDescription& camera = robot.cameras[i];
    if (!request.name.empty() && !protocol::usarsim::equal_ignoring_case(camera.name, request.name)) continue;
    if (!found) writer.begin(request.geometry ? "GEO" : "CONF").text("Type", request.type);
    found = true;
    if (request.geometry && camera.mission_package) {
      const physics::MissionPackageDescription& package = robot.mission_packages[*camera.mission_package];
      add_mount(writer, simulation.dialect, camera.name, package.X_BM, robot, format, package.name);
    } else if (request.geometry) {
      add_mount(writer, simulation.dialect, camera.name, camera.X_BC, robot, format);
    } else {
      writer.text("Name", camera.name)
          .number("CameraDefFov", camera.field_of_view_rad, format)
          .number("CameraMinFov", camera.min_field_of_view_rad, format)
          .number("CameraMaxFov", camera.max_field_of_view_rad, format)
          .number("CameraFov", session.robot->camera_field_of_view_rad[i], format)
          .integer("CameraResX", camera.width)
          .integer("CameraResY", camera.height);
    }
  }
  if (found) writer.end();
  return found;
}

void reply(const Simulation& simulation, Session& session, const MessageView& message, bool geometry) {
  const Request request{printable(text_of(message, "Type")), printable(text_of(message, "Name")), geometry};
  MessageWriter writer(session.out);
  if (session.robot) {
    const physics::RobotDescription& robot = *session.robot->description;
    if (request.type.empty() || is_any_of(request.type, {"Robot", "GroundVehicle"})) {
      if (geometry) return write_robot_geometry(writer, robot, session.formats.value);
      return write_robot_configuration(writer, robot, simulation.dialect, session.formats.value);
    }
    if (write_sensors(writer, simulation, session, request)) return;
    if (is_any_of(request.type, {"MisPkg", "Actuator"}) && write_mission_packages(writer, session, request)) {
      return;
    }
    if (is_any_of(request.type, {"Joint"}) && write_flippers(writer, session, request)) return;
    if (is_any_of(request.type, {"Camera"}) && write_cameras(writer, simulation, session, request)) return;
  }
  writer.begin(geometry ? "GEO" : "CONF").text("Type", request.type);
  if (!request.name.empty()) writer.text("Name", request.name);
  writer.end();
}

}  // namespace

void get_geometry(Simulation& simulation, Session& session, const MessageView& message) {
  reply(simulation, session, message, true);
}

void get_configuration(Simulation& simulation, Session& session, const MessageView& message) {
  reply(simulation, session, message, false);
}

}  // namespace kenaf::world_server
