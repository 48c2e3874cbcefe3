// Decides who commands the robot: opens and closes sessions, numbers States, drops old commands, and stops the robot
// when its commander falls silent. docs/relay-protocol.md has the rules. No sockets, no clock of its own.
//
// Thread safety: one object, one thread. Only the text of a refusal allocates.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "formats/protocol/log_limiter.hpp"
#include "formats/protocol/relay_datagram.hpp"
#include "relayd/answer_limiter.hpp"
#include "relayd/sensor_transform.hpp"
#include "relayd/sockets.hpp"

namespace kenaf::relayd {

// Requirements of a session on the relay around it.
class SessionPort {
 public:
  virtual void send(const Peer& to, const protocol::relay::Datagram& datagram) = 0;
  // Starts a session with the world; CommanderSession::on_world_ready() or on_world_lost() follows, at once or later.
  virtual void open_world(const protocol::relay::Hello& hello) = 0;
  virtual void close_world() = 0;  // stops the robot and lets robot time run
  virtual void drive(const protocol::relay::Command& command, std::optional<std::int64_t> world_frame) = 0;
  virtual void stop_robot() = 0;
  // Returns false if the world server cannot answer; otherwise CommanderSession::on_pong() follows.
  virtual bool ping_world(std::uint32_t id) = 0;

 protected:
  ~SessionPort() = default;
};

// The settings of a world session in force.
struct WorldReady {
  double robot_time_s = 0;
  double period_s = 0.2;
  bool lockstep = false;
};

class CommanderSession {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;
  using Duration = std::chrono::steady_clock::duration;

  // Wall-clock times.
  static constexpr Duration kSilenceEndsSession = std::chrono::seconds(1);
  static constexpr Duration kWorldMustOpenIn = std::chrono::seconds(5);
  static constexpr Duration kWorldIsSlow = std::chrono::seconds(1);       // a commander that asks again is told
  static constexpr Duration kHeartbeat = std::chrono::milliseconds(100);  // a State at least that often
  static constexpr Duration kLostResend = std::chrono::milliseconds(50);
  static constexpr Duration kForgetEnded = std::chrono::seconds(1);  // a Hello of the session until then is late

  explicit CommanderSession(SessionPort& port) : port_(port) {}

  void on_datagram(const protocol::relay::Datagram& datagram, const Peer& from, TimePoint now);
  void on_world_ready(const WorldReady& ready, TimePoint now);
  void on_frame(const WorldFrame& frame, TimePoint now);
  void on_pong(std::uint32_t id, TimePoint now);
  void on_world_lost(std::string_view why, TimePoint now);
  // Handles the passing of time. While the world gives no sign of life there are no heartbeats, so that the commander
  // notices.
  void on_time(TimePoint now, bool world_is_alive);
  // The relay ends: tells the commander and stops the robot.
  void shut_down(TimePoint now);

  // Returns the next time at which on_time() has work.
  std::optional<TimePoint> next_deadline() const;
  // Returns the session that commands the robot or is about to, 0 = none.
  std::uint64_t session() const { return is_open() ? hello_.session : 0; }
  bool is_opening() const { return phase_ == Phase::opening; }
  const Address& commander() const { return commander_.address; }

 private:
  enum class Phase {
    none,
    opening,  // the world server is being asked
    active,
    lost,  // the world server is gone; the commander is being notified
  };

  bool is_open() const { return phase_ == Phase::opening || phase_ == Phase::active; }
  bool is_commander(std::uint64_t session, const Peer& from);
  void take(const protocol::relay::Hello& hello, const Peer& from, TimePoint now);
  void take(const protocol::relay::Command& command, const Peer& from, TimePoint now);
  void take(const protocol::relay::Ping& ping, const Peer& from, TimePoint now);
  void take(const protocol::relay::Bye& bye, const Peer& from, TimePoint now);
  void tell_of_slow_world(TimePoint now);
  void accept(const protocol::relay::Command& command);
  void refuse(std::uint64_t session, const Peer& to, protocol::relay::RefusedReason reason, std::string_view text);
  void send_welcome();
  void send_state(TimePoint now);
  void end(std::string_view why, TimePoint now);

  SessionPort& port_;
  Phase phase_ = Phase::none;
  protocol::relay::Hello hello_{};
  protocol::relay::Welcome welcome_{};
  Peer commander_;
  TimePoint opened_, heard_, sent_;

  protocol::relay::State state_{};       // as last sent
  std::int64_t frame_offset_ = 0;        // State.frame = the world's frame + this
  std::uint32_t late_before_ = 0;        // the world's count before the session
  std::uint32_t late_counted_here_ = 0;  // counted here for a world server that does not count
  bool world_counts_late_ = false;
  double commanded_s_ = 0;  // robot time of the newest Command
  bool stopped_by_silence_ = false;

  struct Ended {
    std::uint64_t session = 0;
    TimePoint when;
  };
  std::array<Ended, 8> ended_{};
  std::size_t next_ended_ = 0;
  protocol::LogLimiter log_stranger_, log_range_, log_future_;
  AnswerLimiter answers_to_strangers_;
};

}  // namespace kenaf::relayd
