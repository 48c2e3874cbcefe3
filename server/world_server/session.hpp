// One connection, without its socket: the client's settings and its pending output.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "formats/protocol/foreign_opening.hpp"
#include "formats/protocol/log_limiter.hpp"
#include "formats/protocol/usarsim_message.hpp"
#include "physics/world.hpp"
#include "server/world_server/dialect.hpp"
#include "server/world_server/frame_schedule.hpp"

namespace kenaf::world_server {

// The robot of a connection.
struct SessionRobot {
  physics::RobotId id{};
  std::string name;
  const physics::RobotDescription* description = nullptr;
  robot::Command command;   // the client's; in force unless an operator holds the robot
  bool normalized = false;  // the client's speeds are percentages of the maximum; sticky
  bool light = false;
  std::string start_instead;    // the start pose that it got because the first was not free; empty: it was
  bool fault_reported = false;  // the failure of its simulation was reported
  struct {
    double speed = 0, front_rad = 0, rear_rad = 0;
  } ackermann;  // last received values
  struct {
    double linear_mps = 0, clockwise_radps = 0;
  } body_velocity;
  std::vector<double> camera_field_of_view_rad;  // of each camera of the description, as zoomed; within its limits
};

// The client's command has ended: a later DRIVE that names only part of a curve finds the rest of it at 0.
inline void forget_curve(SessionRobot& robot) {
  robot.ackermann = {};
  robot.body_velocity = {};
}

// The stop of a silent commander, repeated in every step, because command_loss may drop any single command, but only
// once per step: each command is a draw of command_loss, and how often a step is examined depends on the wall clock.
class SilenceStop {
 public:
  // Returns true on the first call in this step.
  bool due(std::uint64_t step) { return std::exchange(commanded_in_, step) != step; }
  // The commander has spoken. During a pause he may speak and fall silent again within one step.
  void over() { commanded_in_.reset(); }

 private:
  std::optional<std::uint64_t> commanded_in_;
};

// Somebody driving by hand: a connection of the live view. Never reused within one server.
enum class OperatorId : std::uint32_t {};

// An operator's hold on a robot; server/world_server/manual_drive.hpp has the rules.
struct ManualHold {
  OperatorId holder;
  robot::Command command;  // in force, replacing the client's
  double last_word_wall_s;
  bool silent = false;  // stopped until the next command
  SilenceStop stop{};
};

struct Session {
  std::uint32_t id = 0;  // never reused within one server
  std::string peer;      // for log lines
  protocol::Opening opening;
  protocol::usarsim::LineSplitter lines;
  std::string next_line;  // was taken from `lines`, and is for the next turn; empty: none
  std::string out;        // not yet handed to the socket
  bool close = false;     // the connection must be closed

  Formats formats{};
  bool extended = false;  // sent CONTROL {Type Session}
  bool world_controller = false;
  std::optional<SessionRobot> robot;
  std::optional<ManualHold> hold;
  bool placed_by_operator = false;  // it has no client
  FrameSchedule schedule;
  std::string deferred;  // lines that take effect when the next frame begins

  std::uint64_t command_timeout_steps = 0;  // 0: the robot keeps its command
  std::uint64_t last_command_step = 0;
  bool silent = false;
  SilenceStop stop;
  bool peer_silent = false;  // nothing is heard of the client's machine: its robot is stopped
  std::string owner;         // key of the client; a newer connection with the same one replaces this one. Empty: none

  std::uint64_t bad_lines = 0;
  protocol::LogLimiter bad_line_log{1, 5};
  protocol::LogLimiter lockstep_log{1, 5};
};

}  // namespace kenaf::world_server
