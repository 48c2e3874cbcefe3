// From a fresh connection to a robot in the world: what is asked in which order, and when the answers suffice. Works
// with servers that know the extensions and with those that do not. No sockets, no clock of its own.
//
//   server: NFO                      (or nothing for 1 s)
//   relay:  GETSTARTPOSES            only where neither a start nor a pose was chosen
//   server: NFO {StartPoses ...}     (or nothing for 0.5 s: the world's origin)
//   relay:  INIT, GETCONF and GETGEO Robot, GETCONF Encoder, CONTROL Session, all in one piece, so that a server that
//           reads whole pieces lets no robot time pass between the robot's placement and its lock step
//   server: CONF, GEO, ..., RES Session OK, STA: extended. STA, but no RES within 0.5 s of it: plain.
//
// Thread safety: one object, one thread.
#pragma once

#include <array>
#include <chrono>
#include <optional>
#include <string>

#include "protocol/usarsim_message.hpp"
#include "relayd/command_transform.hpp"
#include "relayd/commander_session.hpp"

namespace kenaf::relayd {

struct RobotPlacement {
  std::string class_name = "USARBot.Kenaf";
  std::string name = "Kenaf";
  std::string start;                          // name of a start pose
  std::optional<std::array<double, 6>> pose;  // x, y, z, roll, pitch, yaw in the world (REP 103); before `start`
};

// The answer to CONTROL {Type Session}.
struct SessionAnswer {
  WorldReady ready;
  std::string refusal;  // the server's words; empty = accepted
};
std::optional<SessionAnswer> read_session_answer(const usarsim::MessageView& message);

class WorldHandshake {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;
  enum class Result { pending, extended, plain, failed };

  WorldHandshake(const RobotPlacement& placement, const WorldSession& session, TimePoint connected);

  // Both append to `out` what is to be sent. on_message() gets every message of the server until result() tells.
  void on_message(const usarsim::MessageView& message, TimePoint now, std::string& out);
  void on_time(TimePoint now, std::string& out);

  Result result() const { return result_; }
  TimePoint deadline() const { return deadline_; }    // of on_time()
  const WorldReady& ready() const { return ready_; }  // once extended
  const std::string& failure() const { return failure_; }

 private:
  enum class Step { greeting, choosing_start, placing };

  void after_greeting(TimePoint now, std::string& out);
  void place(const std::string& start, TimePoint now, std::string& out);
  void fail(std::string why);

  RobotPlacement placement_;
  WorldSession session_;
  Step step_ = Step::greeting;
  Result result_ = Result::pending;
  TimePoint deadline_;
  bool accepted_ = false;  // RES Session OK
  bool has_robot_ = false;
  WorldReady ready_;
  std::string failure_;
};

}  // namespace kenaf::relayd
