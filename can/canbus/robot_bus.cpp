#include "can/canbus/robot_bus.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <numbers>

#include "formats/description/description_file.hpp"
#include "formats/description/flipper_pairs.hpp"
#include "formats/description/toml_reader.hpp"

namespace kenaf::canbus {
namespace {

using description::kPositive;
using description::Range;
using description::TomlReader;

using canopen::DriveMode;
using canopen::NodeId;

constexpr double kTurn_rad = 2 * std::numbers::pi;
constexpr Range kCounts{.min = -1e9, .max = 1e9};
constexpr Range kAngle{.min = -kTurn_rad, .max = kTurn_rad};
// Limits of stop_within_s. A collision must not be the first sign of a silent commander.
constexpr Range kStopWithin{.min = 0.05, .max = 2};
constexpr std::size_t kMaxDrivesASide = 8;  // as many as there may be wheels
constexpr int kBitRate = 500'000;
constexpr double kWrapAtLeast_s = 0.05;  // a drive silent for longer is lost anyway

DriveMode read_mode(TomlReader& table, std::array<DriveMode, 2> choice) {
  const std::string text = table.text("mode");
  for (const DriveMode mode : choice) {
    if (text == canopen::describe(mode)) return mode;
  }
  table.fail("mode", fmt::format("is \"{}\", but must be \"{}\" or \"{}\"", text, canopen::describe(choice[0]),
                                 canopen::describe(choice[1])));
}

int read_direction(TomlReader& table, std::string_view key = "direction") {
  const int direction = table.integer(key, -1, 1);
  if (direction == 0) table.fail(key, "is 0, but must be 1 or -1");
  return direction;
}

// The device file that `device` names: a shipped one, or a path, which counts from the file that names it.
std::optional<Device> read_device(TomlReader& table) {
  if (!table.has("device")) return std::nullopt;
  const std::string name = table.text("device");
  const std::filesystem::path path(name), folder = std::filesystem::path(table.file()).parent_path();
  const bool is_relative = name.find('/') != std::string::npos && path.is_relative();
  try {
    Device device = load_device(is_relative ? (folder / path).string() : name);
    device.name = name;
    return device;
  } catch (const description::DescriptionError& error) {
    table.fail("device", fmt::format("is \"{}\": {}", name, error.what()));
  }
}

// Motor, encoder and gear of one kind of drive. `turns_per_unit`: motor turns for 1 m of track or 1 rad of flipper.
DriveOnBus read_kind(TomlReader& table, double turns_per_unit) {
  DriveOnBus drive{};
  if (std::optional<Device> common = read_device(table)) drive.device = std::move(*common);
  drive.units.counts_per_unit = table.number("counts_per_turn", {.min = 1, .max = 1e8}) * turns_per_unit;
  drive.units.velocity_per_unit = table.number("velocity_units_per_turn", kPositive) * turns_per_unit;
  drive.units.acceleration_per_unit = table.number("acceleration_units_per_turn", kPositive) * turns_per_unit;
  return drive;
}

double motor_turns(TomlReader& table) {
  return table.number("gear_ratio", {.min = 1e-3, .max = 1e5});
}

// One drive of its kind: its place on the bus, and its direction of rotation.
DriveOnBus read_drive(TomlReader& table, DriveOnBus drive) {
  drive.node = static_cast<NodeId>(table.integer("node", 1, canopen::kMaxNode));
  if (std::optional<Device> own = read_device(table)) drive.device = std::move(*own);
  if (drive.homing && drive.homing->offset_direction == 0)
    drive.homing->offset_direction = drive.device.home_offset_direction;
  const int direction = read_direction(table);
  drive.units.counts_per_unit *= direction;
  drive.units.velocity_per_unit *= direction;
  if (table.has("zero_counts")) drive.units.zero_counts = table.number("zero_counts", kCounts);
  table.finish();
  return drive;
}

// 0x606C of 16 bits must hold the full speed, with some beyond it, since drives overshoot.
void check_velocity(TomlReader& table, const DriveOnBus& drive) {
  constexpr double kMost = std::numeric_limits<std::int16_t>::max();
  const double full_speed = std::abs(drive.max_speed * drive.units.velocity_per_unit);
  if (drive.device.velocity == VelocitySign::low_16_bits && 1.1 * full_speed > kMost)
    table.fail("device", fmt::format("has velocities of 16 bits (velocity of {}), too few for the full speed, which is "
                                     "{:.0f} by velocity_units_per_turn",
                                     drive.device.name, full_speed));
}

// A flipper's counter must tell all of its range apart; a track's may wrap, but not within kWrapAtLeast_s.
void check_counter(TomlReader& table, const DriveOnBus& drive) {
  if (!is_position(drive.mode)) check_velocity(table, drive);
  const int bits = drive.device.position_bits;
  if (bits == 32) return;
  const double counts = std::ldexp(1, bits);
  const double counts_per_unit = std::abs(drive.units.counts_per_unit);
  if (is_position(drive.mode) && (drive.max_position - drive.min_position) * counts_per_unit >= counts) {
    table.fail("device",
               fmt::format("has a position of {} bits (position_bits of {}), too few for the flipper's range "
                           "of {:.0f} counts",
                           bits, drive.device.name, (drive.max_position - drive.min_position) * counts_per_unit));
  }
  if (!is_position(drive.mode) && 2 * kWrapAtLeast_s * drive.max_speed * counts_per_unit >= counts) {
    table.fail("device", fmt::format("has a position of {} bits (position_bits of {}), too few to tell which way the "
                                     "track turns: it wraps within {} s",
                                     bits, drive.device.name, 2 * kWrapAtLeast_s));
  }
}

// Checks that the limits fit the drive's 32-bit numbers.
void check_numbers(TomlReader& table, const DriveOnBus& drive) {
  check_counter(table, drive);
  const double most = std::numeric_limits<std::int32_t>::max();
  const auto check = [&](std::string_view key, double value, const char* what) {
    if (std::abs(value) > most)
      table.fail(key,
                 fmt::format("makes {} {:.3g} in the drive's units, which do not fit in its 32 bits", what, value));
    if (std::abs(value) < 1) table.fail(key, fmt::format("makes {} less than one of the drive's units", what));
  };
  check("velocity_units_per_turn", drive.max_speed * drive.units.velocity_per_unit, "the full speed");
  check("acceleration_units_per_turn", drive.acceleration * drive.units.acceleration_per_unit, "the acceleration");
  check("acceleration_units_per_turn", drive.quick_stop_deceleration * drive.units.acceleration_per_unit,
        "the quick stop's deceleration");
  for (const double position : {drive.min_position, drive.max_position}) {
    if (std::abs(drive.units.zero_counts + position * drive.units.counts_per_unit) > most)
      table.fail("counts_per_turn", "makes the flipper's limits exceed the 32 bits of the drive's position");
  }
}

Homing read_homing(TomlReader table) {
  Homing homing{};
  homing.method = static_cast<std::int8_t>(table.integer("method", -128, 127));
  homing.home_rad = table.number("home_rad", kAngle);
  homing.offset_direction = table.has("offset_direction") ? read_direction(table, "offset_direction") : 0;
  homing.speed_radps = table.number("speed_radps", {.min = 0, .max = 3, .open_min = true});
  homing.acceleration_radps2 = table.number("acceleration_radps2", kPositive);
  homing.patience_s = table.number("patience_s", {.min = 0, .max = 120, .open_min = true});
  table.finish();
  return homing;
}

// The drives of one side: `kind` with their names, "track left" for a single one, else "track left 1" and so on.
void read_side(TomlReader& table, std::string_view part, robot::Track side, DriveOnBus kind, RobotBus& bus) {
  const std::string_view key = robot::kTrackNames[side];
  std::vector<TomlReader> drives = table.one_or_more_tables(key);
  if (drives.size() > kMaxDrivesASide)
    table.fail(key, fmt::format("lists {} drives, but must list at most {}", drives.size(), kMaxDrivesASide));
  kind.side = side;
  kind.drives_of_side = drives.size();
  for (std::size_t i = 0; i < drives.size(); ++i) {
    kind.name = fmt::format("{} {}", part, key);
    if (drives.size() > 1) kind.name += fmt::format(" {}", i + 1);
    bus.drives.push_back(read_drive(drives[i], kind));
  }
}

// `part`: "track" or "wheel", which the drives turn.
void read_sides(TomlReader table, std::string_view part, TomlReader motor, RobotBus& bus) {
  const double radius_m = motor.number("sprocket_radius_m", kPositive);
  DriveOnBus kind = read_kind(table, motor_turns(table) / (kTurn_rad * radius_m));
  kind.mode = read_mode(table, {DriveMode::profile_velocity, DriveMode::cyclic_velocity});
  kind.max_speed = motor.number("max_speed_mps", kPositive);
  kind.acceleration = table.number("acceleration_mps2", {.min = 0, .max = 100, .open_min = true});
  kind.quick_stop_deceleration = table.number("quick_stop_mps2", {.min = 0, .max = 1000, .open_min = true});
  bus.speed_loop_s = table.number("speed_loop_s", {.min = 0, .max = 1});
  check_numbers(table, kind);
  for (const robot::Track side : {robot::kLeft, robot::kRight}) read_side(table, part, side, kind, bus);
  for (const DriveOnBus& drive : bus.drives) check_counter(table, drive);
  table.finish();
  if (longest_stop_s(bus) > bus.stop_within_s) {
    table.fail("quick_stop_mps2",
               fmt::format("lets a {} run for {:.3f} s after the master fell silent (master_silence_s, a ramp from {} "
                           "m/s, and the drive's lag behind it, speed_loop_s, until {} m/s); it must stop within {} s "
                           "(can.stop_within_s)",
                           part, longest_stop_s(bus), kind.max_speed, kAtRest_mps, bus.stop_within_s));
  }
}

// A robot on wheels has its drives in [can.wheel], one on tracks in [can.track]: each as its running gear is called in
// the rest of its description, so that messages name a part that the robot has. Otherwise the two tables are alike.
void read_travel(TomlReader& table, TomlReader& file, RobotBus& bus) {
  const std::string_view part = file.has("wheel") ? "wheel" : "track", other = file.has("wheel") ? "track" : "wheel";
  if (table.has(other)) {
    table.fail(other, fmt::format("is for a robot on {}s; the drives of this one, which has {}s, belong in [can.{}]",
                                  other, part, part));
  }
  read_sides(table.table(part), part, file.table("drive"), bus);
}

void read_flippers(TomlReader table, TomlReader joint, TomlReader servo, RobotBus& bus) {
  DriveOnBus kind = read_kind(table, motor_turns(table) / kTurn_rad);
  kind.mode = read_mode(table, {DriveMode::profile_position, DriveMode::cyclic_position});
  kind.max_speed = servo.number("max_speed_radps", kPositive);
  kind.min_position = joint.number("min_angle_rad", kAngle);
  kind.max_position = joint.number("max_angle_rad", kAngle);
  kind.acceleration = table.number("acceleration_radps2", {.min = 0, .max = 1e4, .open_min = true});
  kind.quick_stop_deceleration = table.number("quick_stop_radps2", {.min = 0, .max = 1e4, .open_min = true});
  if (table.has("homing")) kind.homing = read_homing(table.table("homing"));
  const description::FlipperPairs pairs = description::read_flipper_pairs(joint);
  constexpr std::array<std::string_view, robot::kFlipperCount> kKeys{"front_left", "front_right", "rear_left",
                                                                     "rear_right"};
  for (std::size_t i = 0; i < kKeys.size(); ++i) {
    const auto flipper = static_cast<robot::Flipper>(i);
    if (!(robot::is_front(flipper) ? pairs.front : pairs.rear)) {
      if (table.has(kKeys[i])) table.fail(kKeys[i], "is a flipper that this robot has not: `pairs` in [flipper]");
      continue;
    }
    kind.side = robot::side_of(flipper);
    kind.flipper = flipper;
    kind.name = fmt::format("flipper {}", kKeys[i]);
    std::ranges::replace(kind.name, '_', ' ');
    TomlReader one = table.table(kKeys[i]);
    bus.drives.push_back(read_drive(one, kind));
    check_numbers(table, bus.drives.back());
  }
  table.finish();
}

InclinometerAxis read_axis(TomlReader table) {
  InclinometerAxis axis{};
  const std::string name = table.text("axis");
  if (name != "lateral" && name != "longitudinal")
    table.fail("axis", fmt::format("is \"{}\", but must be \"lateral\" or \"longitudinal\"", name));
  axis.lateral = name == "lateral";
  axis.direction = read_direction(table);
  axis.zero_rad = table.number("zero_rad", kAngle);
  table.finish();
  return axis;
}

InclinometerOnBus read_inclinometer(TomlReader table) {
  InclinometerOnBus out{};
  out.node = static_cast<NodeId>(table.integer("node", 1, canopen::kMaxNode));
  out.roll = read_axis(table.table("roll"));
  out.pitch = read_axis(table.table("pitch"));
  if (out.roll.lateral == out.pitch.lateral) table.fail("pitch", "is on the same axis of the sensor as roll");
  table.finish();
  return out;
}

GyroOnBus read_gyro(TomlReader table) {
  GyroOnBus out{};
  out.node = static_cast<NodeId>(table.integer("node", 1, canopen::kMaxNode));
  out.pdo = static_cast<std::uint8_t>(table.integer("pdo", 1, 4));
  out.first_bit = static_cast<std::uint8_t>(table.integer("first_bit", 0, 56));
  out.bits = static_cast<std::uint8_t>(table.integer("bits", 2, 32));
  if (out.first_bit + out.bits > 64) table.fail("bits", "reaches beyond the eight bytes of a frame");
  out.units_per_radps = table.number("units_per_radps");
  if (out.units_per_radps == 0) table.fail("units_per_radps", "is 0");
  table.finish();
  return out;
}

std::vector<OtherOnBus> read_others(std::vector<TomlReader> tables) {
  std::vector<OtherOnBus> out;
  for (TomlReader& table : tables) {
    OtherOnBus other{.name = table.text("name"),
                     .node = static_cast<NodeId>(table.integer("node", 1, canopen::kMaxNode)),
                     .bits_per_s = table.number_or("bits_per_s", 0, {.min = 0, .max = 1e6})};
    if (other.name.empty() || other.name.size() > 60) table.fail("name", "must be of 1 to 60 characters");
    table.finish();
    out.push_back(std::move(other));
  }
  return out;
}

void check_nodes(TomlReader& table, const RobotBus& bus) {
  std::map<NodeId, std::string_view> taken;
  const auto take = [&](NodeId node, std::string_view name, std::string_view key) {
    const auto [where, is_new] = taken.emplace(node, name);
    if (!is_new) table.fail(key, fmt::format("has node {} twice: {} and {}", node, where->second, name));
  };
  take(bus.master, "the master", "master_node");
  for (const DriveOnBus& drive : bus.drives)
    take(drive.node, drive.name, drive.is_flipper() ? "flipper" : table.has("wheel") ? "wheel" : "track");
  if (bus.inclinometer) take(bus.inclinometer->node, "inclinometer", "inclinometer");
  if (bus.gyro) take(bus.gyro->node, "gyro", "gyro");
  for (const OtherOnBus& other : bus.others) take(other.node, other.name, "other");
}

// Between the tracks, or the wheels in the mean; 0 if the description has neither.
double gauge_m(TomlReader& file) {
  if (file.has("track")) return 2 * file.table("track").vector3("left_center_m")[1];
  std::vector<TomlReader> wheels = file.tables("wheel");
  double sum_m = 0;
  for (TomlReader& wheel : wheels) sum_m += 2 * wheel.vector3("left_center_m")[1];
  return wheels.empty() ? 0 : sum_m / static_cast<double>(wheels.size());
}

}  // namespace

RobotBus parse_robot_bus(std::string_view toml_text, const std::string& name_for_errors) {
  // A description without [can] is for simulation only.
  const toml::table root = description::parse_toml(toml_text, name_for_errors);
  TomlReader file(root, "", name_for_errors);
  if (!file.has("can")) {
    throw description::DescriptionError(
        fmt::format("{}: has no table [can], which lists the devices on the robot's CAN bus", name_for_errors));
  }
  TomlReader table = file.table("can");

  // The bus and its master. A silence of two heartbeats at least, so that one that is late stops nothing.
  RobotBus bus{};
  bus.interface = table.text("interface");
  if (bus.interface.empty() || bus.interface.size() > 15) table.fail("interface", "must be of 1 to 15 characters");
  bus.bit_rate = table.has("bit_rate") ? table.integer("bit_rate", 10'000, 1'000'000) : kBitRate;
  bus.master = static_cast<NodeId>(table.integer("master_node", 1, canopen::kMaxNode));
  bus.master_heartbeat_s = table.number("master_heartbeat_s", {.min = 0.005, .max = 0.1});
  bus.master_silence_s = table.number("master_silence_s", {.min = 0.01, .max = 0.2});
  if (bus.master_silence_s < 2 * bus.master_heartbeat_s)
    table.fail("master_silence_s", "is less than two heartbeats: one late heartbeat would stop the robot");
  // Heartbeats, measured quantities and answer time-out of the nodes.
  bus.node_heartbeat_s = table.number("node_heartbeat_s", {.min = 0.01, .max = 10});
  bus.has_currents = !table.has("currents") || table.boolean("currents");
  if (table.has("realtime_priority")) bus.realtime_priority = table.integer("realtime_priority", 1, 99);
  bus.lock_memory = table.has("lock_memory") && table.boolean("lock_memory");
  if (table.has("event_timer")) bus.event_timer = table.boolean("event_timer");
  bus.has_battery = !table.has("battery") || table.boolean("battery");
  bus.answer_s = table.number("answer_s", {.min = 0.01, .max = 10});
  bus.stop_within_s = table.number_or("stop_within_s", bus.stop_within_s, kStopWithin);

  // Drives take speeds, limits and radius from the tables that the simulator reads too.
  bus.track_gauge_m = gauge_m(file);
  read_travel(table, file, bus);
  if (file.has("flipper"))
    read_flippers(table.table("flipper"), file.table("flipper"), file.table("servo"), bus);
  else if (table.has("flipper"))
    table.fail("flipper", "has drives for flippers, but this description has no [flipper]");

  // What one drive does not have, the robot does not have.
  for (const DriveOnBus& drive : bus.drives) bus.has_currents = bus.has_currents && drive.device.currents;
  bus.has_battery = bus.has_battery && bus.drives.front().device.battery;

  // Optional sensors; finally, node ids must be unique.
  if (table.has("inclinometer")) bus.inclinometer = read_inclinometer(table.table("inclinometer"));
  if (table.has("gyro")) bus.gyro = read_gyro(table.table("gyro"));
  bus.others = read_others(table.tables("other"));
  check_nodes(table, bus);
  table.finish();
  return bus;
}

RobotBus load_robot_bus(const std::string& name_or_path) {
  const description::DescriptionFile file = description::read_description_file("robot", name_or_path, ".toml");
  return parse_robot_bus(file.text, file.path);
}

bool has_flippers(const RobotBus& bus) {
  return std::ranges::any_of(bus.drives, &DriveOnBus::is_flipper);
}

canopen::DriveMode first_mode(const DriveOnBus& drive) {
  return drive.homing && drive.device.mode_change == ModeChange::disabled ? DriveMode::homing : drive.mode;
}

int life_time_factor(const RobotBus& bus) {
  return static_cast<int>(std::floor(bus.master_silence_s / bus.master_heartbeat_s + 1e-9));
}

double longest_stop_s(const RobotBus& bus) {
  return longest_stop_s(bus, bus.master_silence_s);
}

double longest_stop_s(const RobotBus& bus, double silence_s) {
  const DriveOnBus& track = bus.drives.front();
  const double v = track.max_speed, a = track.quick_stop_deceleration, tau = bus.speed_loop_s;
  const double ramp_s = v / a;
  if (tau == 0) return silence_s + ramp_s;

  // The speed u follows the demand by tau u' = (v - a t) - u, u(0) = v:
  //   u(t) = v - a t + a tau (1 - exp(-t / tau)), at the ramp's end a tau (1 - exp(-ramp_s / tau)),
  // and from there on decays with tau.
  const double at_end_of_ramp = -a * tau * std::expm1(-ramp_s / tau);
  return silence_s + ramp_s + tau * std::log(std::max(1.0, at_end_of_ramp / kAtRest_mps));
}

std::int32_t position_to_drive(const DriveUnits& units, double position) {
  return static_cast<std::int32_t>(std::lround(units.zero_counts + position * units.counts_per_unit));
}

double position_from_drive(const DriveUnits& units, std::int32_t counts) {
  return (counts - units.zero_counts) / units.counts_per_unit;
}

std::int32_t velocity_to_drive(const DriveUnits& units, double velocity) {
  return static_cast<std::int32_t>(std::lround(velocity * units.velocity_per_unit));
}

double velocity_from_drive(const DriveUnits& units, std::int32_t velocity) {
  return velocity / units.velocity_per_unit;
}

std::uint32_t acceleration_to_drive(const DriveUnits& units, double acceleration) {
  return static_cast<std::uint32_t>(std::lround(acceleration * units.acceleration_per_unit));
}

}  // namespace kenaf::canbus
