#include "tools/describe/from_urdf.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <optional>

#include "physics/robot_description.hpp"
#include "tools/describe/body_of_urdf.hpp"
#include "tools/describe/draft.hpp"
#include "tools/describe/gazebo_tags.hpp"
#include "tools/describe/running_gear.hpp"

namespace kenaf::describe {
namespace {

using description::DescriptionError;
using std::numbers::pi;

constexpr double kGravity_mps2 = 9.81;

// The sources of all tables.
struct Robot {
  const UrdfModel& model;
  const Roles& roles;
  const RunningGear& gear;
  const UrdfBody& body;
  std::vector<std::string>& warnings;

  double weight_n() const {
    return kGravity_mps2 * (body.mass.mass_kg + (gear.flippers ? 4 * gear.flippers->mass_kg : 0));
  }
  double rolling_radius_m() const { return gear.track ? gear.track->end_radius_m : gear.wheels.front().radius_m; }
  double battery_v() const { return body.mass.mass_kg > 15 ? 25.2 : 12.6; }
};

// To two digits, as a person would choose it.
double rounded(double value) {
  if (value == 0) return 0;
  const double unit = std::pow(10, std::floor(std::log10(std::abs(value))) - 1);
  return std::round(value / unit) * unit;
}

void add_friction(Table& table, const Robot& robot, const std::vector<std::size_t>& links) {
  const auto found = friction_of(robot.model, links, robot.warnings);
  if (found) {
    table.from_urdf("friction_along", toml_number(found->along), "for Gazebo");
    table.from_urdf("friction_across", toml_number(found->across), "for Gazebo");
  } else {
    table.chosen("friction_along", "0.8", "rubber");
    table.chosen("friction_across", "0.8", "rubber");
  }
}

std::string class_of(const UrdfModel& model) {
  std::string name;
  for (const char c : model.name)
    if (std::isalnum(static_cast<unsigned char>(c))) name += c;
  if (name.empty()) name = "Robot";
  name[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
  return "USARBot." + name;
}

Table top_of(const Robot& robot, const std::string& usarsim_class) {
  Table table;
  if (usarsim_class.empty())
    table.chosen("usarsim_class", toml_text(class_of(robot.model)), "the robot's name");
  else
    table.add("usarsim_class", toml_text(usarsim_class), Source::given);
  return table;
}

Table body_table(const Robot& robot) {
  Table table{.name = "body", .entries = {}};
  const MassProperties& mass = robot.body.mass;
  table.from_urdf("mass_kg", toml_number(mass.mass_kg),
                  robot.gear.flippers ? "all links but the flippers" : "all links");
  table.from_urdf("size_m", toml_vector(robot.body.size_m), "around the hull's shapes");
  table.from_urdf("center_of_mass_m", toml_vector(mass.p_ACm_m));
  table.from_urdf("inertia_kgm2", toml_vector(mass.inertia_kgm2.diagonal()));
  const auto friction = friction_of(robot.model, robot.roles.hull, robot.warnings);
  if (friction)
    table.from_urdf("friction", toml_number(friction->along), "for Gazebo");
  else
    table.chosen("friction", "0.5", "smooth hull");
  return table;
}

// A place that is given in F for the plane of symmetry.
std::string place_in_B(const Robot& robot, double x_m, double half_gauge_m, double z_m) {
  const Eigen::Vector3d& p_FB = robot.body.X_FB.p;
  return toml_vector({x_m - p_FB.x(), half_gauge_m, z_m - p_FB.z()});
}

void check_gap(const Robot& robot, const std::string& name, double half_gauge_m, double width_m) {
  if (half_gauge_m <= width_m / 2)
    throw DescriptionError(
        fmt::format("{}: \"{}\" reaches across the robot's middle: it is {:.4g} m wide, {:.4g} m from it",
                    robot.model.file, name, width_m, half_gauge_m));
}

Table track_table(const Robot& robot) {
  const TrackPair& track = *robot.gear.track;
  check_gap(robot, robot.model.links[track.left.front()].name, track.half_gauge_m, track.width_m);
  Table table{.name = "track", .entries = {}};
  table.from_urdf("length_m", toml_number(track.length_m));
  table.from_urdf("end_radius_m", toml_number(track.end_radius_m), track.radius_of_box ? "half of the height" : "");
  table.from_urdf("width_m", toml_number(track.width_m));
  table.from_urdf("left_center_m", place_in_B(robot, track.x_m, track.half_gauge_m, track.z_m));
  std::vector<std::size_t> links = track.left;
  links.insert(links.end(), track.right.begin(), track.right.end());
  add_friction(table, robot, links);
  table.chosen("lug_height_m", "0.0", "a smooth belt");
  table.chosen("pieces", "6", "enough to share the load as a belly does");
  return table;
}

std::optional<double> if_positive(double value) {
  return value > 0 ? std::optional(value) : std::nullopt;
}

// Adds the number that the URDF states, or where it states none the chosen one.
void add_stated(Table& table, const char* key, std::optional<double> stated, const char* what_it_is, double otherwise,
                const char* why) {
  if (stated)
    table.from_urdf(key, toml_number(*stated), what_it_is);
  else
    table.chosen(key, toml_number(otherwise), why);
}

Table wheel_table(const Robot& robot, const WheelPair& pair) {
  const double width_m = pair.width_m.value_or(rounded(pair.radius_m / 2));
  check_gap(robot, robot.model.links[pair.left.link].name, pair.half_gauge_m, width_m);
  Table table{.name = "wheel", .one_of_several = true, .entries = {}};
  table.from_urdf("left_center_m", place_in_B(robot, pair.x_m, pair.half_gauge_m, pair.z_m));
  table.from_urdf("radius_m", toml_number(pair.radius_m));
  add_stated(table, "width_m", pair.width_m, "", width_m, "half of the radius");
  std::vector<std::size_t> links = subtree(robot.model, pair.left.link);
  std::ranges::copy(subtree(robot.model, pair.right.link), std::back_inserter(links));
  add_friction(table, robot, links);
  return table;
}

Table caster_table(const Robot& robot, const Rolling& caster) {
  Table table{.name = "caster", .one_of_several = true, .entries = {}};
  table.from_urdf("center_m", toml_vector(caster.p_FW_m - robot.body.X_FB.p));
  table.from_urdf("radius_m", toml_number(caster.radius_m));
  add_stated(table, "width_m", caster.width_m, "", rounded(caster.radius_m / 2), "half of the radius");
  const auto friction = friction_of(robot.model, subtree(robot.model, caster.link), robot.warnings);
  add_stated(table, "friction", friction ? std::optional(friction->along) : std::nullopt, "for Gazebo", 0.03, "");
  return table;
}

// Limits and inertia by the joints of the wheels; 0: not stated.
struct WheelJoints {
  double max_speed_mps = 0, max_force_n = 0, moving_mass_kg = 0;
};

WheelJoints joints_of_wheels(const Robot& robot) {
  WheelJoints all;
  for (const WheelPair& pair : robot.gear.wheels)
    for (const Rolling& wheel : {pair.left, pair.right}) {
      const UrdfJoint& joint = robot.model.links[wheel.link].joint;
      const double speed_mps = joint.velocity * wheel.radius_m;
      if (speed_mps > 0) all.max_speed_mps = all.max_speed_mps > 0 ? std::min(all.max_speed_mps, speed_mps) : speed_mps;
      all.max_force_n += joint.effort / wheel.radius_m / 2;  // both sides count
      const MassProperties mass = mass_of(robot.model, subtree(robot.model, wheel.link));
      all.moving_mass_kg += moment_about(mass, robot.model.links[wheel.link].X_FL.p, joint.axis_F) /
                            (wheel.radius_m * wheel.radius_m) / 2;
    }
  return all;
}

Table drive_table(const Robot& robot) {
  // Joints of wheels state limits; tracks have no joint, so theirs are chosen.
  const WheelJoints joints = joints_of_wheels(robot);
  const double radius_m = robot.rolling_radius_m();
  const double max_speed_mps = joints.max_speed_mps > 0 ? joints.max_speed_mps : 1.0;
  Table table{.name = "drive", .entries = {}};
  if (robot.gear.track)
    table.chosen("sprocket_radius_m", toml_number(radius_m), "at the belt's outer face");
  else
    table.from_urdf("sprocket_radius_m", toml_number(radius_m), "the wheel's radius");
  add_stated(table, "max_speed_mps", if_positive(joints.max_speed_mps), "velocity limit", max_speed_mps, "");
  add_stated(table, "max_force_n", if_positive(joints.max_force_n), "effort limits of a side",
             rounded(0.8 * robot.weight_n() / 2), "friction of 0.8 gives way first");
  table.chosen("time_constant_s", "0.1");
  add_stated(table, "moving_mass_kg", if_positive(joints.moving_mass_kg), "wheels of a side, without rotor and gear",
             rounded(0.08 * robot.body.mass.mass_kg), "8 % of the mass");
  table.chosen("encoder_counts_per_radian", "318.30988618", "2000 counts a turn");
  table.chosen("amperes_per_newton", toml_number(rounded(max_speed_mps / robot.battery_v())),
               fmt::format("what {} V give at full speed without losses", robot.battery_v()));
  table.chosen("idle_amperes", "0.3");
  return table;
}

Table flipper_table(const Robot& robot) {
  const FlipperSet& flippers = *robot.gear.flippers;
  Table table{.name = "flipper", .entries = {}};
  table.from_urdf("mass_kg", toml_number(flippers.mass_kg));
  table.from_urdf("length_m", toml_number(flippers.length_m));
  table.from_urdf("pivot_radius_m", toml_number(flippers.pivot_radius_m));
  table.from_urdf("tip_radius_m", toml_number(flippers.tip_radius_m));
  table.from_urdf("width_m", toml_number(flippers.width_m));
  table.from_urdf("front_left_pivot_m",
                  toml_vector({flippers.half_length_m, flippers.half_gauge_m, flippers.z_m - robot.body.X_FB.p.z()}));
  add_friction(table, robot, flippers.links);
  const Source source = flippers.limited ? Source::urdf : Source::chosen;
  table.add("min_angle_rad", toml_number(flippers.min_angle_rad), source, flippers.limited ? "" : "no limits");
  table.add("max_angle_rad", toml_number(flippers.max_angle_rad), source, flippers.limited ? "" : "no limits");
  table.chosen("start_angle_rad", "0.0", "straight out");
  table.chosen("belt_driven", "true");
  return table;
}

Table servo_table(const Robot& robot) {
  const FlipperSet& flippers = *robot.gear.flippers;
  const double max_speed_radps = flippers.velocity_radps > 0 ? flippers.velocity_radps : 1.5;
  Table table{.name = "servo", .entries = {}};
  add_stated(table, "max_speed_radps", if_positive(flippers.velocity_radps), "velocity limit", max_speed_radps, "");
  add_stated(table, "max_torque_nm", if_positive(flippers.effort_nm), "effort limit",
             rounded(robot.weight_n() * flippers.length_m / 4), "two flippers lift an end of the robot");
  table.chosen("amperes_per_nm", toml_number(rounded(max_speed_radps / robot.battery_v())), "without losses");
  return table;
}

Table battery_table(const Robot& robot) {
  Table table{.name = "battery", .entries = {}};
  table.chosen("open_circuit_v", toml_number(robot.battery_v()));
  table.chosen("internal_resistance_ohm", "0.05");
  table.chosen("capacity_s", "3600.0");
  return table;
}

// Those that every description has, as hrt.h reads them.
void append_usual_sensors(Draft& draft) {
  for (const char* type : {"GroundTruth", "INS", "Encoder", "Odometry", "Tachometer", "Drives"}) {
    Table table{.name = "sensor", .one_of_several = true, .entries = {}};
    table.chosen("type", toml_text(type));
    table.chosen("name", toml_text(type));
    if (type == std::string_view("INS")) {
      table.chosen("noise_m", "0.01");
      table.chosen("noise_rad", "0.0017", "0.1 degree");
    }
    draft.tables.push_back(std::move(table));
  }
}

std::vector<std::string> heading_of(const Robot& robot) {
  const Eigen::Vector3d& p_FB = robot.body.X_FB.p;
  return {fmt::format("{}: made of {} by kenaf-describe.", robot.model.name,
                      std::filesystem::path(robot.model.file).filename().string()),
          "docs/descriptions.md explains every key. SI units; x forward, y left, z up. What was chosen is marked so.",
          "", fmt::format("Origin of B: {} m in the axes of the URDF's {}.", toml_vector(p_FB), robot.model.base)};
}

Draft draft_of(const Robot& robot, const std::string& usarsim_class) {
  Draft draft{.heading = heading_of(robot), .tables = {top_of(robot, usarsim_class), body_table(robot)}};
  if (robot.gear.track) draft.tables.push_back(track_table(robot));
  for (const WheelPair& pair : robot.gear.wheels) draft.tables.push_back(wheel_table(robot, pair));
  for (const Rolling& caster : robot.gear.casters) draft.tables.push_back(caster_table(robot, caster));
  draft.tables.push_back(drive_table(robot));
  if (robot.gear.flippers) {
    draft.tables.push_back(flipper_table(robot));
    draft.tables.push_back(servo_table(robot));
  }
  draft.tables.push_back(battery_table(robot));
  append_usual_sensors(draft);
  append_gazebo_sensors(robot.model, robot.body.X_FB, draft, robot.warnings);
  return draft;
}

}  // namespace

MadeDescription from_urdf(std::string_view xml, const std::string& file, const FromUrdfOptions& options) {
  // Reads the URDF and the roles of its links.
  MadeDescription made;
  Meshes meshes(options.folders);
  const UrdfModel model = read_urdf(xml, file, made.warnings);
  const Roles roles = find_roles(model, options.choice, meshes, made.warnings);
  const RunningGear gear = find_running_gear(model, roles, meshes, options.tolerance_m, made.warnings);
  const UrdfBody body = find_body(model, roles, gear, meshes, made.warnings);

  // The file, which must load.
  Draft draft = draft_of({model, roles, gear, body, made.warnings}, options.usarsim_class);
  for (const std::string& assignment : options.set) set_value(draft, assignment);
  made.toml = toml_of(draft);
  made.chosen = chosen_keys(draft);
  try {
    physics::parse_robot(made.toml, "description");
  } catch (const DescriptionError& error) {
    throw DescriptionError(fmt::format(
        "{}: the description that it makes would not load: {}; --set gives a key another value", file, error.what()));
  }
  return made;
}

}  // namespace kenaf::describe
