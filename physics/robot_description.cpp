#include "physics/robot_description.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include "formats/description/data_files.hpp"
#include "formats/description/description_file.hpp"
#include "formats/description/flipper_pairs.hpp"
#include "formats/description/toml_reader.hpp"

namespace kenaf::physics {
namespace {

using description::kNotNegative;
using description::kPositive;
using description::Range;
using description::TomlReader;

using std::numbers::pi;
constexpr Range kFriction{.min = 0, .max = 10};
constexpr Range kLugHeights{.min = 0, .max = 0.05};
constexpr Range kMaxDelay{.min = 0, .max = 10};
constexpr std::size_t kMaxWheelsASide = 8;
constexpr std::size_t kMaxCasters = 4;
constexpr std::size_t kMaxSensors = 64;
constexpr std::size_t kMaxRays = 4096;
constexpr std::size_t kMaxCameras = 8;
constexpr int kMaxPixelsASide = 4096;

constexpr std::array<std::string_view, 11> kTypeNames{"GroundTruth", "INS",        "IMU",   "Encoder",
                                                      "Odometry",    "Tachometer", "Sonar", "RangeScanner",
                                                      "GPS",         "Touch",      "Drives"};

Eigen::Vector3d vector_at(TomlReader& table, std::string_view key, Range range = description::kAny) {
  const std::array<double, 3> components = table.vector3(key, range);
  return Eigen::Vector3d::Map(components.data());
}

BodyDescription read_body(TomlReader table) {
  BodyDescription body{
      .mass_kg = table.number("mass_kg", kPositive),
      .size_m = vector_at(table, "size_m", kPositive),
      .p_BBcm_m = vector_at(table, "center_of_mass_m"),
      .inertia_kgm2 = vector_at(table, "inertia_kgm2", kPositive),
      .friction = table.number("friction", kFriction),
  };
  // No rigid body has a moment of inertia larger than the sum of the two others.
  const Eigen::Vector3d& I = body.inertia_kgm2;
  if (2 * I.maxCoeff() > I.sum() * (1 + 1e-9))
    table.fail("inertia_kgm2", "belongs to no rigid body: one moment is larger than the sum of the two others");
  table.finish();
  return body;
}

TrackDescription read_track(TomlReader table) {
  TrackDescription track{
      .length_m = table.number("length_m", kPositive),
      .end_radius_m = table.number("end_radius_m", kPositive),
      .width_m = table.number("width_m", kPositive),
      .p_BT_m = vector_at(table, "left_center_m"),
      .friction_along = table.number("friction_along", kFriction),
      .friction_across = table.number("friction_across", kFriction),
      .pieces = table.integer("pieces", 1, 32),
      .lug_height_m = table.number_or("lug_height_m", 0, kLugHeights),
      .shear_deformation_m = table.number_or("shear_deformation_m", 0, {.min = 0, .max = 0.2}),
  };
  if (track.length_m <= 2 * track.end_radius_m) table.fail("length_m", "must be more than twice end_radius_m");
  if (track.p_BT_m.y() <= track.width_m / 2) table.fail("left_center_m", "must have a y of more than half of width_m");
  table.finish();
  return track;
}

// A pair of wheels.
TrackDescription read_wheel(TomlReader& table) {
  const double radius_m = table.number("radius_m", kPositive);
  TrackDescription wheel{
      .length_m = 2 * radius_m,
      .end_radius_m = radius_m,
      .width_m = table.number("width_m", kPositive),
      .p_BT_m = vector_at(table, "left_center_m"),
      .friction_along = table.number("friction_along", kFriction),
      .friction_across = table.number("friction_across", kFriction),
      .pieces = 1,
      .lug_height_m = table.number_or("lug_height_m", 0, kLugHeights),
  };
  if (wheel.p_BT_m.y() <= wheel.width_m / 2) table.fail("left_center_m", "must have a y of more than half of width_m");
  table.finish();
  return wheel;
}

CasterDescription read_caster(TomlReader& table) {
  CasterDescription caster{
      .p_BC_m = vector_at(table, "center_m"),
      .radius_m = table.number("radius_m", kPositive),
      .width_m = table.number("width_m", kPositive),
      .friction = table.number("friction", kFriction),
  };
  table.finish();
  return caster;
}

// A robot has tracks, with or without flippers, or wheels, with or without casters.
void read_running_gear(TomlReader& file, RobotDescription& robot) {
  if (!file.has("wheel")) {
    if (file.has("caster")) file.fail("caster", "is for robots with [[wheel]]: a robot on tracks has none");
    robot.track.push_back(read_track(file.table("track")));
    return;
  }
  if (file.has("track"))
    file.fail("wheel", "and [track] exclude each other: a robot drives on two tracks, or on wheels alone");
  if (file.has("flipper")) file.fail("wheel", "and [flipper] exclude each other: flippers belong to robots on tracks");
  for (TomlReader& table : file.tables("wheel")) {
    robot.track.push_back(read_wheel(table));
    if (robot.track.size() > kMaxWheelsASide)
      table.fail("left_center_m", fmt::format("is one wheel too many: at most {} on a side", kMaxWheelsASide));
    if (robot.track.size() > 1 && robot.track.back().p_BT_m.x() >= robot.track[robot.track.size() - 2].p_BT_m.x())
      table.fail("left_center_m", "must have a smaller x than the wheel before: the front one comes first");
  }
  if (robot.track.empty()) file.fail("wheel", "is empty: a robot has a wheel on each side at least");
  for (TomlReader& table : file.tables("caster")) {
    robot.caster.push_back(read_caster(table));
    if (robot.caster.size() > kMaxCasters)
      table.fail("center_m", fmt::format("is one caster too many: at most {}", kMaxCasters));
  }
}

TrackDriveDescription read_drive(TomlReader table) {
  const TrackDriveDescription drive{
      .sprocket_radius_m = table.number("sprocket_radius_m", kPositive),
      .max_speed_mps = table.number("max_speed_mps", kPositive),
      .max_force_n = table.number("max_force_n", kPositive),
      .time_constant_s = table.number("time_constant_s", kNotNegative),
      .moving_mass_kg = table.number("moving_mass_kg", kPositive),
      .encoder_counts_per_radian = table.number("encoder_counts_per_radian", kPositive),
      .amperes_per_newton = table.number("amperes_per_newton", kNotNegative),
      .idle_amperes = table.number("idle_amperes", kNotNegative),
  };
  table.finish();
  return drive;
}

void read_flippers(TomlReader table, RobotDescription& robot) {
  robot.flipper_pairs = description::read_flipper_pairs(table);
  const FlipperDescription flipper{
      .mass_kg = table.number("mass_kg", kPositive),
      .length_m = table.number("length_m", kPositive),
      .pivot_radius_m = table.number("pivot_radius_m", kPositive),
      .tip_radius_m = table.number("tip_radius_m", kPositive),
      .width_m = table.number("width_m", kPositive),
      .p_BPivot_m = vector_at(table, "front_left_pivot_m"),
      .friction_along = table.number("friction_along", kFriction),
      .friction_across = table.number("friction_across", kFriction),
      .min_angle_rad = table.number("min_angle_rad", {.min = -2 * pi, .max = 0}),
      .max_angle_rad = table.number("max_angle_rad", {.min = 0, .max = 2 * pi}),
      .start_angle_rad = table.number("start_angle_rad"),
      .belt_driven = table.boolean("belt_driven"),
  };
  // Otherwise one drum would lie within the other, and the belt would have no straight run.
  if (flipper.length_m <= std::abs(flipper.pivot_radius_m - flipper.tip_radius_m))
    table.fail("length_m", "must be more than the difference of pivot_radius_m and tip_radius_m");
  if (flipper.start_angle_rad < flipper.min_angle_rad || flipper.start_angle_rad > flipper.max_angle_rad)
    table.fail("start_angle_rad", "must be between min_angle_rad and max_angle_rad");
  if (flipper.p_BPivot_m.x() <= 0 || flipper.p_BPivot_m.y() <= 0)
    table.fail("front_left_pivot_m", "must have x and y of more than 0: it is the front left one");
  table.finish();
  robot.flipper.push_back(flipper);
}

FlipperServoDescription read_servo(TomlReader table) {
  const FlipperServoDescription servo{
      .max_speed_radps = table.number("max_speed_radps", kPositive),
      .max_torque_nm = table.number("max_torque_nm", kPositive),
      .amperes_per_nm = table.number("amperes_per_nm", kNotNegative),
      .resolution_rad = table.number_or("resolution_rad", 0, {.min = 0, .max = 1}),
  };
  table.finish();
  return servo;
}

BatteryDescription read_battery(TomlReader table) {
  const BatteryDescription battery{
      .open_circuit_v = table.number("open_circuit_v", kPositive),
      .internal_resistance_ohm = table.number("internal_resistance_ohm", kNotNegative),
      .capacity_s = table.number("capacity_s", kPositive),
  };
  table.finish();
  return battery;
}

Pose read_mount(TomlReader& table) {
  const auto vector_or_zero = [&table](std::string_view key) -> Eigen::Vector3d {
    return table.has(key) ? vector_at(table, key) : Eigen::Vector3d::Zero();
  };
  return {vector_or_zero("mount_m"), rotation_from(vector_or_zero("mount_rpy_rad"))};
}

SensorDescription read_sensor(TomlReader& table) {
  // Type and name.
  SensorDescription sensor{};
  const std::string type = table.text("type");
  const auto found = std::find(kTypeNames.begin(), kTypeNames.end(), type);
  if (found == kTypeNames.end())
    table.fail("type", fmt::format("is \"{}\", but must be one of {}", type, fmt::join(kTypeNames, ", ")));
  sensor.type = static_cast<SensorType>(found - kTypeNames.begin());
  sensor.name = table.text("name");
  if (sensor.name.empty() || sensor.name.find_first_of("{} \t\r\n") != std::string::npos)
    table.fail("name", "must not be empty nor hold blanks or braces");

  // Place, timing and errors; which of the errors apply depends on the type.
  sensor.X_BS = read_mount(table);
  sensor.period_s = table.number_or("period_s", 0, {.min = 0, .max = 3600});
  sensor.delay_s = table.number_or("delay_s", 0, kMaxDelay);
  sensor.noise_m = table.number_or("noise_m", 0, kNotNegative);
  sensor.noise_rad = table.number_or("noise_rad", 0, kNotNegative);
  sensor.noise_radps = table.number_or("noise_radps", 0, kNotNegative);
  sensor.noise_mps2 = table.number_or("noise_mps2", 0, kNotNegative);
  sensor.noise_a = table.number_or("noise_a", 0, kNotNegative);
  sensor.noise_v = table.number_or("noise_v", 0, kNotNegative);
  sensor.bias_rad = table.number_or("bias_rad", 0, kNotNegative);
  sensor.bias_radps = table.number_or("bias_radps", 0, kNotNegative);

  // Ray sensors: range and field of view; the resolution bounds the number of rays.
  if (sensor.type == SensorType::sonar || sensor.type == SensorType::range_scanner) {
    sensor.min_range_m = table.number("min_range_m", kNotNegative);
    sensor.max_range_m = table.number("max_range_m", kPositive);
    if (sensor.max_range_m <= sensor.min_range_m) table.fail("max_range_m", "must be more than min_range_m");
    sensor.field_of_view_rad = table.number("field_of_view_rad", {.min = 0, .max = 2 * pi});
  }
  if (sensor.type == SensorType::range_scanner) {
    sensor.resolution_rad = table.number("resolution_rad", kPositive);
    if (std::round(sensor.field_of_view_rad / sensor.resolution_rad) + 1 > static_cast<double>(kMaxRays))
      table.fail("resolution_rad", fmt::format("makes more than {} rays in a scan", kMaxRays));
  }
  table.finish();
  return sensor;
}

MissionPackageDescription read_mission_package(TomlReader& table) {
  MissionPackageDescription package{.name = table.text("name"), .X_BM = read_mount(table), .links = {}};
  for (TomlReader& link : table.tables("link")) {
    package.links.push_back({.min_rad = link.number("min_rad"),
                             .max_rad = link.number("max_rad"),
                             .max_speed_radps = link.number("max_speed_radps", kPositive)});
    if (package.links.back().max_rad < package.links.back().min_rad) link.fail("max_rad", "must not be below min_rad");
    link.finish();
  }
  if (package.links.empty())
    table.fail("link", "is missing: a mission package has at least one [[mission_package.link]]");
  table.finish();
  return package;
}

CameraDescription read_camera(TomlReader& table, const std::vector<MissionPackageDescription>& packages) {
  // Beyond 170 degrees, a plane picture is all border.
  constexpr Range kFieldOfView{.min = 0.01, .max = 170 * pi / 180};
  CameraDescription camera{};
  camera.name = table.text("name");
  if (camera.name.empty() || camera.name.find_first_of("{} \t\r\n") != std::string::npos)
    table.fail("name", "must not be empty nor hold blanks or braces");
  if (table.has("mount")) {
    const std::string mount = table.text("mount");
    const auto package = std::ranges::find(packages, mount, &MissionPackageDescription::name);
    if (package == packages.end())
      table.fail("mount", fmt::format("is \"{}\", but the robot has no [[mission_package]] of that name", mount));
    if (package->links.size() > 2) table.fail("mount", "must have one link or two: pan, and tilt");
    camera.mission_package = static_cast<std::size_t>(package - packages.begin());
    if (table.has("mount_m") || table.has("mount_rpy_rad"))
      table.fail("mount", "is the camera's place: mount_m and mount_rpy_rad are for cameras without it");
  } else {
    camera.X_BC = read_mount(table);
  }
  camera.width = table.integer("width", 16, kMaxPixelsASide);
  camera.height = table.integer("height", 16, kMaxPixelsASide);
  camera.field_of_view_rad = table.number("field_of_view_rad", kFieldOfView);
  camera.min_field_of_view_rad = table.number_or("min_field_of_view_rad", camera.field_of_view_rad, kFieldOfView);
  camera.max_field_of_view_rad = table.number_or("max_field_of_view_rad", camera.field_of_view_rad, kFieldOfView);
  if (camera.min_field_of_view_rad > camera.field_of_view_rad ||
      camera.max_field_of_view_rad < camera.field_of_view_rad)
    table.fail("field_of_view_rad", "must be between min_field_of_view_rad and max_field_of_view_rad");
  camera.rate_hz = table.number("rate_hz", {.min = 0.1, .max = 120});
  camera.latency_s = table.number_or("latency_s", 0, {.min = 0, .max = 2});
  camera.jpeg_quality = table.has("jpeg_quality") ? table.integer("jpeg_quality", 1, 100) : 80;
  table.leave("device");  // of the real robot's camera: libkenaf_real/camera_on_robot.hpp
  table.finish();
  return camera;
}

// From the front end to the rear end of all that rolls, if each is as long as `length_m` says, about its centre.
double reach_m(const RobotDescription& robot, double (*length_m)(const TrackDescription&)) {
  std::vector<TrackDescription> rolling = robot.track;
  for (const CasterDescription& caster : robot.caster) rolling.push_back(caster.as_wheel());
  double front_m = -std::numeric_limits<double>::infinity(), rear_m = std::numeric_limits<double>::infinity();
  for (const TrackDescription& t : rolling) {
    front_m = std::max(front_m, t.p_BT_m.x() + length_m(t) / 2);
    rear_m = std::min(rear_m, t.p_BT_m.x() - length_m(t) / 2);
  }
  return front_m - rear_m;
}

Effects read_effects(TomlReader file) {
  Effects effects;
  for (const EffectInfo& effect : effect_catalogue()) {
    if (!file.has(effect.name)) continue;
    TomlReader table = file.table(effect.name);
    for (const EffectParameter& parameter : effect.parameters)
      effects.*(parameter.value) =
          table.number_or(parameter.name, parameter.neutral, {.min = parameter.min, .max = parameter.max});
    table.finish();
  }
  file.finish();
  return effects;
}

}  // namespace

std::string_view usarsim_type_name(SensorType type) {
  return kTypeNames[static_cast<std::size_t>(type)];
}

TrackDescription CasterDescription::as_wheel() const {
  return {.length_m = 2 * radius_m,
          .end_radius_m = radius_m,
          .width_m = width_m,
          .p_BT_m = p_BC_m,
          .friction_along = friction,
          .friction_across = friction,
          .pieces = 1,
          .lug_height_m = 0};
}

double RobotDescription::total_mass_kg() const {
  return body.mass_kg + (has_flippers() ? static_cast<double>(flipper_count()) * flipper.front().mass_kg : 0.0);
}

std::size_t RobotDescription::flipper_count() const {
  if (!has_flippers()) return 0;
  return robot::kFlipperCount / 2 * (std::size_t{flipper_pairs.front} + std::size_t{flipper_pairs.rear});
}

double RobotDescription::track_gauge_m() const {
  double sum_m = 0;
  for (const TrackDescription& t : track) sum_m += 2 * t.p_BT_m.y();
  return sum_m / static_cast<double>(track.size());
}

double RobotDescription::track_length_m() const {
  return reach_m(*this, [](const TrackDescription& t) { return t.length_m; });
}

double RobotDescription::contact_length_m() const {
  return reach_m(*this, [](const TrackDescription& t) { return t.straight_m(); });
}

double RobotDescription::outer_width_m() const {
  double half_m = 0;
  for (const TrackDescription& t : track) half_m = std::max(half_m, t.p_BT_m.y() + t.width_m / 2);
  return 2 * half_m;
}

double RobotDescription::ride_height_m() const {
  double height_m = track.front().end_radius_m - track.front().p_BT_m.z();
  for (const TrackDescription& t : track) height_m = std::max(height_m, t.end_radius_m - t.p_BT_m.z());
  return height_m;
}

double RobotDescription::encoder_factor(robot::Track side) const {
  return effects.encoder_scale * side_factor(side, effects.encoder_asymmetry);
}

RobotDescription parse_robot(std::string_view toml_text, const std::string& name_for_errors) {
  const toml::table root = description::parse_toml(toml_text, name_for_errors);
  TomlReader file(root, "", name_for_errors);
  RobotDescription robot{};
  robot.name = std::filesystem::path(name_for_errors).stem().string();
  robot.usarsim_class = file.text("usarsim_class");
  robot.body = read_body(file.table("body"));
  read_running_gear(file, robot);
  robot.drive = read_drive(file.table("drive"));
  if (file.has("flipper")) {
    read_flippers(file.table("flipper"), robot);
    robot.servo = read_servo(file.table("servo"));
  }
  robot.battery = read_battery(file.table("battery"));

  // Lists; names are unique within each.
  std::set<std::string> names;
  for (TomlReader& table : file.tables("sensor")) {
    robot.sensors.push_back(read_sensor(table));
    if (!names.insert(robot.sensors.back().name).second) table.fail("name", "is the name of another sensor too");
    if (robot.sensors.size() > kMaxSensors)
      table.fail("name", fmt::format("is one sensor too many: at most {}", kMaxSensors));
  }
  for (TomlReader& table : file.tables("mission_package"))
    robot.mission_packages.push_back(read_mission_package(table));
  names.clear();
  for (TomlReader& table : file.tables("camera")) {
    robot.cameras.push_back(read_camera(table, robot.mission_packages));
    if (!names.insert(robot.cameras.back().name).second) table.fail("name", "is the name of another camera too");
    if (robot.cameras.size() > kMaxCameras)
      table.fail("name", fmt::format("is one camera too many: at most {}", kMaxCameras));
  }
  if (file.has("effects")) robot.effects = read_effects(file.table("effects"));
  file.leave("can");  // of the real robot's bus: can/canbus/robot_bus.hpp
  file.finish();
  return robot;
}

RobotDescription load_robot(const std::string& name_or_path) {
  const description::DescriptionFile file = description::read_description_file("robot", name_or_path, ".toml");
  return parse_robot(file.text, file.path);
}

std::size_t SensorDescription::scan_values() const {
  return static_cast<std::size_t>(std::lround(field_of_view_rad / resolution_rad)) + 1;
}

std::string robot_name_for_class(std::string_view usarsim_class) {
  std::string name(usarsim_class.substr(usarsim_class.rfind('.') + 1));  // npos + 1 is 0
  for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  // Accepts names only, no paths: a remote client cannot reach files outside share/robots/.
  const bool plain = !name.empty() && std::all_of(name.begin(), name.end(), [](unsigned char c) {
    return std::isalnum(c) || c == '_' || c == '-';
  });
  return plain && !description::find_data_file("robots", name, ".toml").empty() ? name : std::string();
}

}  // namespace kenaf::physics
