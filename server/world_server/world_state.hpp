// The visible state of the simulation: a plain value that other threads can read while the world continues.
//
// SI units, radians, frames of REP 103. Thread safety: a value. It is not published: a reader passes an empty or old
// one to the world's thread (WorldServer::ask) and gets it back filled. So it costs nothing without readers, the reader
// sets the rate, the world never waits for a lock, and refilling an old one does not allocate.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "physics/robot_dimensions.hpp"
#include "server/world_server/simulation.hpp"

namespace kenaf::world_server {

// A camera of a robot. Positive pan to the left, positive tilt down.
struct CameraState {
  std::string name;
  int width = 0, height = 0;  // pixels
  double min_field_of_view_rad = 0, max_field_of_view_rad = 0, field_of_view_rad = 0;
  struct Link {
    double min_rad, max_rad, angle_rad;
  };
  std::optional<Link> pan, tilt;  // present angles, if a mount turns it
};

// What a ray sensor of a robot has before it, without the sensor's noise and delay.
struct RangeScan {
  std::string name;
  physics::Pose X_WS;            // looks along x
  double field_of_view_rad = 0;  // in the plane of x and y; of a sonar the opening of its cone
  bool sonar = false;
  std::vector<double> range_m;  // evenly over the field of view, the left end first; infinite: nothing within its range
};

// What an inertial sensor feels, without noise. The acceleration, less gravity, is that of the whole robot's centre of
// mass: the sum of the contacts' forces by its mass.
struct InertialState {
  Eigen::Vector3d p_W{0, 0, 0};  // of its mount
  Eigen::Vector3d a_W_mps2{0, 0, 0}, w_W_radps{0, 0, 0};
};

struct RobotState {
  std::uint32_t id = 0;       // of its session: never reused within one server
  physics::RobotId robot{0};  // in the world; likewise
  std::string name, class_name;
  physics::RobotDimensions dimensions;
  physics::Pose X_WB;
  Eigen::Vector3d v_WB_mps{0, 0, 0};
  std::array<double, robot::kTrackCount> track_mps{}, track_m{}, track_a{};
  std::array<double, robot::kFlipperCount> flipper_rad{}, flipper_a{};  // NaN and 0 where the robot has no flipper
  double battery_v = 0, battery_left_s = 0;
  robot::Command command;          // in force
  bool has_client = false;         // false: an operator placed it
  bool client_silent = false;      // its CommandTimeout has passed
  double client_silent_s = 0;      // robot time since its last command
  std::uint64_t late_answers = 0;  // to its frames
  OperatorId holder{0};            // 0: nobody drives it by hand
  bool holder_silent = false;
  std::string fault;                 // empty: none
  std::vector<CameraState> cameras;  // in the order of its description
  // Only if asked for (StateExtras).
  std::vector<physics::ContactPoint> contacts;
  std::vector<RangeScan> scans;
  std::optional<InertialState> inertial;  // of its first IMU
};

// A box that may have moved from its place in the world's description.
struct BoxState {
  std::uint32_t id = 0;
  Eigen::Vector3d size_m{0, 0, 0};
  physics::Pose X_WBox;
};

struct WorldState {
  double wall_s = 0;  // time of reading, on a steady clock
  double time_s = 0;  // robot time
  std::uint64_t step = 0;
  bool paused = false;
  Pauser pauser;                   // while it is paused
  double speed = 0;                // requested, times real time; 0: as fast as possible
  std::vector<RobotState> robots;  // in order of connection
  std::vector<BoxState> boxes;
};

// What is read on top, because it takes longer than the rest.
struct StateExtras {
  bool contacts = false;                 // of all robots
  std::vector<std::uint32_t> sensors{};  // robots, by their `id`, whose scans and inertial state are read
};

// Rays of a range scanner that are cast for a scan; a scanner with more of them is thinned out.
inline constexpr std::size_t kMostScanRays = 91;

// Reads the world at simulation.wall_s.
void read_state(const Simulation& simulation, WorldState& state, const StateExtras& extras = {});

}  // namespace kenaf::world_server
