// The measured state of a robot in one cycle, from the real robot's library or from the relay of a simulated one.
//
// SI and radians; world W and body B are x forward, y left, z up (REP 103). Angles of a pose are the intrinsic z-y-x
// angles roll, pitch, yaw; pitch is positive nose down.
//
// Thread safety: values and pure functions.
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "robot/parts.hpp"

namespace kenaf::robot {

// Which fields of a State were measured. A field without its bit is 0 and has no meaning.
enum StateField : std::uint32_t {
  kHasPosture = 1u << 0,      // posture_rad: the robot's own orientation sensor
  kHasEncoders = 1u << 1,     // track_m, track_mps
  kHasFlippers = 1u << 2,     // flipper_rad, of those that the robot has
  kHasCurrents = 1u << 3,     // track_a, flipper_a
  kHasBattery = 1u << 4,      // battery_v
  kHasInertial = 1u << 5,     // gyro_radps, acceleration_mps2
  kHasGroundTruth = 1u << 6,  // p_WB_m, orientation_rad: only a simulator knows it
};

// The angle of a flipper that the robot has not. It compares as false with every number.
inline constexpr double kNoFlipper = std::numeric_limits<double>::quiet_NaN();

// A StateField shifted left by this: its sensor reported nothing since the State before, and the value is the last one.
inline constexpr int kHeldShift = 16;

constexpr std::uint32_t held(std::uint32_t fields) {
  return fields << kHeldShift;
}

// Of kHasCurrents, flipper_a alone: drives of flippers may report theirs less often than those of tracks.
inline constexpr std::uint32_t kHeldFlipperCurrents = 1u << 31;

// Measured since the State before, not only held.
constexpr bool is_new(std::uint32_t fields, StateField field) {
  return (fields & field) != 0 && (fields & held(field)) == 0;
}

struct State {
  std::uint32_t frame;          // from 1, one more for each cycle of a session: a gap is a lost State
  std::uint32_t late_commands;  // commands of this session that arrived after the frame they were meant for
  std::uint32_t fields;         // StateField bits, held() ones, and kHeldFlipperCurrents
  bool stopped_by_silence;      // the robot was stopped because no command came in time
  double robot_time_s;
  std::array<double, 3> posture_rad;        // roll, pitch, yaw
  std::array<double, 3> gyro_radps;         // in B
  std::array<double, 3> acceleration_mps2;  // in B, gravity's reaction included: at rest +g on z
  std::array<double, kTrackCount> track_m;  // travel since the robot was placed
  std::array<double, kTrackCount> track_mps;
  std::array<double, kTrackCount> track_a;
  std::array<double, kFlipperCount> flipper_rad;  // kNoFlipper where the robot has none there
  std::array<double, kFlipperCount> flipper_a;
  double battery_v;
  std::array<double, 3> p_WB_m;
  std::array<double, 3> orientation_rad;  // roll, pitch, yaw
};

}  // namespace kenaf::robot
