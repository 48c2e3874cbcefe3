// What the simulation shows of itself: a plain value, for other threads to look at while the world goes on.
//
// SI units, radians, frames of REP 103. Thread safety: a value. Nobody publishes it by himself: who wants to see hands
// an empty one, or an old one, to the world's thread (WorldServer::ask) and gets it back filled. So it costs nothing
// while nobody looks, whoever looks sets the rate, no lock exists that the world could wait for, and an old one is
// filled without allocating.
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
  std::optional<Link> pan, tilt;  // where a mount turns it
};

struct RobotState {
  std::uint32_t id = 0;       // of its session: never used twice in one server
  physics::RobotId robot{0};  // in the world; likewise
  std::string name, class_name;
  physics::RobotDimensions dimensions;
  physics::Pose X_WB;
  Eigen::Vector3d v_WB_mps{0, 0, 0};
  std::array<double, robot::kTrackCount> track_mps{}, track_m{}, track_a{};
  std::array<double, robot::kFlipperCount> flipper_rad{}, flipper_a{};
  double battery_v = 0, battery_left_s = 0;
  robot::Command command;          // in force
  bool has_client = false;         // false: an operator placed it
  bool client_silent = false;      // its CommandTimeout has passed
  double client_silent_s = 0;      // robot time since its last command
  std::uint64_t late_answers = 0;  // of its frames
  OperatorId holder{0};            // 0: nobody drives it by hand
  bool holder_silent = false;
  std::string fault;                 // empty: none
  std::vector<CameraState> cameras;  // in the order of its description
};

// A box that may be elsewhere than the world's description has it.
struct BoxState {
  std::uint32_t id = 0;
  Eigen::Vector3d size_m{0, 0, 0};
  physics::Pose X_WBox;
};

struct WorldState {
  double wall_s = 0;  // when it was read, of a steady clock
  double time_s = 0;  // robot time
  std::uint64_t step = 0;
  bool paused = false;
  double speed = 0;                // times real time that is wanted; 0: as fast as it goes
  std::vector<RobotState> robots;  // in the order of their coming
  std::vector<BoxState> boxes;
};

// As the world is at simulation.wall_s.
void read_state(const Simulation& simulation, WorldState& state);

}  // namespace kenaf::world_server
