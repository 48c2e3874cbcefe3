// The columns of a recorded run: a table with a row for each, used by recorders, diagnosis, report, playback and the
// page docs/logs.md. A new channel needs a row here, and a source of its values: hrt/recorder.cpp for the robot,
// rollout/run_recorder.cpp for the simulator.
//
// Thread safety: constants and pure functions.
#pragma once

#include <algorithm>
#include <span>
#include <string_view>

namespace kenaf::robot {

// The quantity of which a column is a part. Columns of one quantity are adjacent, in the order of robot/parts.hpp or of
// x, y, z.
enum class Quantity {
  time,
  track_command,
  flipper_command,
  track_speed,
  track_travel,
  flipper_angle,
  track_current,
  flipper_current,
  battery_voltage,
  position,
  tilt,
  yaw,
  turn_rate,
  acceleration,
  posture,
  robot_time,
  frame,
  late_commands,
};

// Stage between command and sensor at which a quantity is observed.
enum class Seen { drive, body, sensor };

// How the diagnosis compares a column between robot and simulation.
struct Comparison {
  Seen seen = Seen::drive;
  double resolution = 0;    // smaller differences do not count, in the column's unit (chosen); 0: not compared
  std::string_view kind{};  // columns of one kind share the size of the unexplained residual: "track speed"
  bool level = false;       // ill-conditioned with the nose up or down: small turns of the body change it much
};

struct Column {
  std::string_view name;  // ends with its unit: "track_left_mps"
  std::string_view unit;  // for people: "m/s"
  Quantity quantity;
  bool by_robot = true;      // whether the library records it
  bool by_simulator = true;  // whether the simulator does
  bool wraps = false;        // an angle that wraps at pi
  Comparison comparison{};

  constexpr bool is_compared() const { return comparison.resolution > 0; }
};

// Acceleration is not compared. Between contacts it adds nothing to posture and gyro, and at a contact it is a spike
// whose height depends on the contact's stiffness and the sensor's bandwidth, which are unknown.
namespace column_table {

inline constexpr bool kByBoth = true, kWraps = true, kLevel = true;
inline constexpr double kSpeed_mps = 1e-3, kTravel_m = 1e-3, kAngle_rad = 1e-3, kCurrent_a = 0.05, kVoltage_v = 0.02;
inline constexpr double kPosition_m = 5e-4, kTurn_rad = 5e-4, kRate_radps = 2e-3;

constexpr Column asked(std::string_view name, std::string_view unit, Quantity quantity) {
  return {name, unit, quantity};
}
constexpr Column of_drive(std::string_view name, std::string_view unit, Quantity quantity, double resolution,
                          std::string_view kind, bool wraps = false) {
  return {name, unit, quantity, kByBoth, kByBoth, wraps, {Seen::drive, resolution, kind}};
}
constexpr Column of_body(std::string_view name, std::string_view unit, Quantity quantity, double resolution,
                         std::string_view kind, bool wraps = false, bool level = false) {
  return {name, unit, quantity, kByBoth, kByBoth, wraps, {Seen::body, resolution, kind, level}};
}
constexpr Column of_sensor(std::string_view name, std::string_view unit, Quantity quantity, double resolution,
                           std::string_view kind, bool wraps = false, bool level = false) {
  return {name, unit, quantity, kByBoth, kByBoth, wraps, {Seen::sensor, resolution, kind, level}};
}
constexpr Column of_robot(std::string_view name, std::string_view unit, Quantity quantity, bool wraps = false) {
  return {name, unit, quantity, true, false, wraps};
}

using enum Quantity;

inline constexpr Column kAll[] = {
    asked("t_s", "s", time),
    asked("cmd_track_left_mps", "m/s", track_command),
    asked("cmd_track_right_mps", "m/s", track_command),
    asked("cmd_flipper_fl_rad", "rad", flipper_command),
    asked("cmd_flipper_fr_rad", "rad", flipper_command),
    asked("cmd_flipper_rl_rad", "rad", flipper_command),
    asked("cmd_flipper_rr_rad", "rad", flipper_command),
    of_drive("track_left_mps", "m/s", track_speed, kSpeed_mps, "track speed"),
    of_drive("track_right_mps", "m/s", track_speed, kSpeed_mps, "track speed"),
    of_drive("track_left_m", "m", track_travel, kTravel_m, "track travel"),
    of_drive("track_right_m", "m", track_travel, kTravel_m, "track travel"),
    of_drive("flipper_fl_rad", "rad", flipper_angle, kAngle_rad, "flipper angle", kWraps),
    of_drive("flipper_fr_rad", "rad", flipper_angle, kAngle_rad, "flipper angle", kWraps),
    of_drive("flipper_rl_rad", "rad", flipper_angle, kAngle_rad, "flipper angle", kWraps),
    of_drive("flipper_rr_rad", "rad", flipper_angle, kAngle_rad, "flipper angle", kWraps),
    of_drive("track_left_a", "A", track_current, kCurrent_a, "track current"),
    of_drive("track_right_a", "A", track_current, kCurrent_a, "track current"),
    of_drive("flipper_fl_a", "A", flipper_current, kCurrent_a, "flipper current"),
    of_drive("flipper_fr_a", "A", flipper_current, kCurrent_a, "flipper current"),
    of_drive("flipper_rl_a", "A", flipper_current, kCurrent_a, "flipper current"),
    of_drive("flipper_rr_a", "A", flipper_current, kCurrent_a, "flipper current"),
    of_drive("battery_v", "V", battery_voltage, kVoltage_v, "battery voltage"),
    of_body("x_m", "m", position, kPosition_m, "position"),
    of_body("y_m", "m", position, kPosition_m, "position"),
    of_body("z_m", "m", position, kPosition_m, "height"),
    of_sensor("roll_rad", "rad", tilt, kTurn_rad, "roll", kWraps, kLevel),
    of_sensor("pitch_rad", "rad", tilt, kTurn_rad, "pitch", kWraps),
    of_body("yaw_rad", "rad", yaw, kTurn_rad, "yaw", kWraps, kLevel),
    of_sensor("gyro_x_radps", "rad/s", turn_rate, kRate_radps, "roll rate"),
    of_sensor("gyro_y_radps", "rad/s", turn_rate, kRate_radps, "pitch rate"),
    of_sensor("gyro_z_radps", "rad/s", turn_rate, kRate_radps, "yaw rate"),
    asked("acc_x_mps2", "m/s^2", acceleration),
    asked("acc_y_mps2", "m/s^2", acceleration),
    asked("acc_z_mps2", "m/s^2", acceleration),
    // Beyond the format: the robot's own orientation sensor, and the state of the cycle.
    of_robot("posture_roll_rad", "rad", posture, kWraps),
    of_robot("posture_pitch_rad", "rad", posture, kWraps),
    of_robot("posture_yaw_rad", "rad", posture, kWraps),
    of_robot("robot_time_s", "s", robot_time),
    of_robot("frame", "1", frame),
    of_robot("late_commands", "1", late_commands),
};

}  // namespace column_table

// All columns, in the order in which they are recorded.
constexpr std::span<const Column> columns() {
  return column_table::kAll;
}

// Returns the column of that name, or null.
constexpr const Column* find_column(std::string_view name) {
  const auto found = std::ranges::find(columns(), name, &Column::name);
  return found == columns().end() ? nullptr : &*found;
}

// The columns of a quantity.
constexpr std::span<const Column> columns_of(Quantity quantity) {
  const auto first = std::ranges::lower_bound(columns(), quantity, {}, &Column::quantity);
  const auto last = std::ranges::upper_bound(columns(), quantity, {}, &Column::quantity);
  return {first, last};
}

}  // namespace kenaf::robot
