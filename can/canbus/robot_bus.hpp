// The contents of a robot's CAN bus: the table [can] of its description, with related parts of the rest.
// docs/can-robot.md explains every key. Read by the master (libkenaf_real) and by the simulated drives (candrives).
//
// Units: SI at the robot (surface speed of a track, angle of a flipper, 0 = straight out, positive tip up); a drive's
// own units on the bus. Only the functions at the end convert between the two.
//
// Thread safety: values and pure functions, except load_robot_bus, which reads the environment and files.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "can/canbus/device_file.hpp"
#include "can/canopen/drive.hpp"
#include "can/canopen/nmt.hpp"
#include "robot/parts.hpp"

namespace kenaf::canbus {

// Units and range of a drive.
struct DriveUnits {
  double counts_per_unit;        // position: counts for 1 m of track or 1 rad of flipper, with the direction's sign
  double zero_counts = 0;        // position at 0 m or 0 rad
  double velocity_per_unit;      // units of the velocity objects for 1 m/s or 1 rad/s, with the direction's sign
  double acceleration_per_unit;  // units of the acceleration objects for 1 m/s^2 or 1 rad/s^2, positive
};

struct Homing {
  std::int8_t method;  // CiA 402, table of homing methods: 37 = at the present position; others move
  double home_rad;     // flipper's angle at the home position
  // +1: at home the drive's position is its object 0x607C; -1: minus that, as others read CiA 402
  int offset_direction = 1;
  double speed_radps;
  double acceleration_radps2;
  double patience_s;  // for the homing of a flipper
};

struct DriveOnBus {
  std::string name;                       // in messages: "track left", "wheel right 2", "flipper front left"
  robot::Track side;                      // of the robot
  std::optional<robot::Flipper> flipper;  // that it moves; nullopt: it turns its side's track, or wheels of it
  canopen::NodeId node;
  canopen::DriveMode mode;  // tracks, wheels: profile or cyclic velocity; flippers: profile or cyclic position
  DriveUnits units;
  double max_speed;                              // m/s or rad/s
  double acceleration, quick_stop_deceleration;  // m/s^2 or rad/s^2
  double min_position, max_position;             // rad; flippers only
  std::optional<Homing> homing;                  // flippers; nullopt: the encoder is absolute
  Device device{};                               // what its type needs beyond the standards
  std::size_t drives_of_side = 1;                // itself and those that turn the same track or wheels; flippers: 1

  bool is_flipper() const { return flipper.has_value(); }
};

struct InclinometerAxis {
  bool lateral;     // CiA 410: the slope along the sensor's lateral axis; false: along its longitudinal axis
  int direction;    // +1 or -1: from the sensor's slope to the robot's angle: roll left side up, pitch nose down
  double zero_rad;  // the sensor's slope, after direction, when the robot is level
};

struct InclinometerOnBus {
  canopen::NodeId node;
  InclinometerAxis roll, pitch;
};

struct GyroOnBus {
  canopen::NodeId node;
  std::uint8_t pdo;              // 1 to 4: number of the TPDO, as configured in the device; nothing is written to it
  std::uint8_t first_bit, bits;  // place of the yaw rate in it, a signed little-endian number, and its width
  double units_per_radps;        // with the sign that makes a turn to the left positive
};

// A device of somebody else on the bus: nothing is sent to it, and nothing it sends counts. Devices that are on the bus
// and not in the description are left alone too; naming one makes its traffic count in the load of the bus.
struct OtherOnBus {
  std::string name;
  canopen::NodeId node;
  double bits_per_s = 0;  // of its traffic
};

struct RobotBus {
  std::string interface;       // "can0"
  int bit_rate;                // bits per second, as the interface is configured; used for the bus load
  canopen::NodeId master;      // the node id whose heartbeat the drives watch
  double master_heartbeat_s;   // period of that heartbeat
  double master_silence_s;     // the drives stop by themselves after this long without it
  double node_heartbeat_s;     // period of the nodes' heartbeats
  double answer_s;             // patience for each answer during set-up
  double stop_within_s = 0.2;  // limit of longest_stop_s()
  bool has_currents = true;    // the drives measure their current
  // Whether the drives' RPDO1 has an event timer, by which they stop when commands stay away. true: a drive without one
  // is refused; false: none is used; nullopt: used where there is one.
  std::optional<bool> event_timer;
  bool has_battery = true;  // the first drive measures the voltage of its supply
  // Real time for the master's cycles: SCHED_FIFO at this priority, 1 to 99, and memory that is not swapped out.
  std::optional<int> realtime_priority;
  bool lock_memory = false;
  double track_gauge_m;  // between the tracks' centre lines; 0: not in the description
  double speed_loop_s;   // time constant of the track drives' own speed control, by which they lag behind their ramps
  // Those of the left side, at least one, front first; those of the right side, likewise; the flippers that the robot
  // has, in the order of robot::Flipper. All of a side are commanded the same speed.
  std::vector<DriveOnBus> drives;
  std::optional<InclinometerOnBus> inclinometer;
  std::optional<GyroOnBus> gyro;
  std::vector<OtherOnBus> others;
};

bool has_flippers(const RobotBus& bus);

// Takes a shipped name ("kenaf") or the path of a TOML file. Throws DescriptionError with file, line and column: no
// table [can], a key that is missing, unknown or out of range, a node id used twice, values that contradict each other
// (a device file that is missing or wrong; a target beyond a drive's 32-bit numbers; a silence shorter than two
// heartbeats; a stop longer than stop_within_s: see longest_stop_s).
RobotBus load_robot_bus(const std::string& name_or_path);
RobotBus parse_robot_bus(std::string_view toml_text, const std::string& name_for_errors);

// The mode in which the drive is enabled: that of its motions, or homing if the mode cannot change while it is enabled.
canopen::DriveMode first_mode(const DriveOnBus& drive);
// Returns object 0x100D for drives with node guarding: how many of the master's requests, one each master_heartbeat_s,
// fit in master_silence_s.
int life_time_factor(const RobotBus& bus);

// A track or wheel that is slower than this is at rest. Chosen: a drive that follows its demand with a lag never stands
// exactly, and goes on from here by this times its time constant: 1 mm at 0.1 s.
inline constexpr double kAtRest_mps = 0.01;

// Returns the time from the master's last sign of life until the slowest track is at rest: `silence_s` (first form:
// master_silence_s) until the drives notice, a quick stop from full speed, and the lag of their speed control.
double longest_stop_s(const RobotBus& bus);
double longest_stop_s(const RobotBus& bus, double silence_s);

// Converts track travel in m or flipper angle in rad, and speeds. Rounded to the nearest towards the drive; the caller
// keeps within the limits.
std::int32_t position_to_drive(const DriveUnits& units, double position);
double position_from_drive(const DriveUnits& units, std::int32_t counts);
std::int32_t velocity_to_drive(const DriveUnits& units, double velocity);
double velocity_from_drive(const DriveUnits& units, std::int32_t velocity);
std::uint32_t acceleration_to_drive(const DriveUnits& units, double acceleration);

}  // namespace kenaf::canbus
