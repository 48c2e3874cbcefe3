// From a new connection to a robot in the world: requests, their order, and which answers suffice. Works with servers
// with and without the extensions. No sockets, no clock of its own.
//
//   server: NFO                  (or nothing for 1 s)
//   relay:  CONTROL Session, INIT, GETCONF and GETGEO Robot, GETCONF Encoder, in one piece. The session comes first, so
//           that its precision holds for the geometry, and no robot time passes between placement and lock step.
//   server: RES Session OK, GEO, ..., CONF Encoder, STA: it is extended
//           STA, but within 0.5 s of it no RES: it is plain
//
// Thread safety: one object, one thread.
#pragma once

#include <array>
#include <chrono>
#include <optional>
#include <string>

#include "formats/protocol/usarsim_message.hpp"
#include "relayd/command_transform.hpp"
#include "relayd/commander_session.hpp"

namespace kenaf::relayd {

struct RobotPlacement {
  std::string class_name = "USARBot.Kenaf";
  std::string name = "Kenaf";
  std::string start;                          // name of a start pose
  std::optional<std::array<double, 6>> pose;  // x, y, z, roll, pitch, yaw in the world (REP 103); overrides `start`
  // The relay's own key, with which a new connection takes the place of its old one; empty: none.
  std::string owner;
};

// The answer to CONTROL {Type Session}.
struct SessionAnswer {
  WorldReady ready;
  std::string refusal;  // the server's words; empty = accepted
};
std::optional<SessionAnswer> read_session_answer(const protocol::usarsim::MessageView& message);

class WorldHandshake {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;
  enum class Result { pending, extended, plain, failed };

  WorldHandshake(const RobotPlacement& placement, const WorldSession& session, TimePoint connected);

  // Both append the output to `out`. on_message() must get every message of the server until result() is known;
  // `is_frame`: it was a STA that SensorTransform accepted.
  void on_message(const protocol::usarsim::MessageView& message, bool is_frame, TimePoint now, std::string& out);
  void on_time(TimePoint now, std::string& out);

  Result result() const { return result_; }
  TimePoint deadline() const { return deadline_; }    // of on_time()
  const WorldReady& ready() const { return ready_; }  // once extended
  const std::string& failure() const { return failure_; }

 private:
  void place(TimePoint now, std::string& out);
  void fail(std::string why);

  const RobotPlacement placement_;
  const WorldSession session_;
  TimePoint deadline_;
  Result result_ = Result::pending;
  bool greeted_ = false;
  bool accepted_ = false;         // RES Session OK
  bool has_calibration_ = false;  // CONF Encoder, the last answer of an extended server
  bool has_robot_ = false;        // STA
  WorldReady ready_;
  std::string failure_;
};

}  // namespace kenaf::relayd
