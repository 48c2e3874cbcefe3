// A world with its clients: all of the world server except sockets and a clock of its own.
//
// Thread safety: none; one thread owns a Simulation. Wall-clock time is passed as an argument: seconds of a steady
// clock.
#pragma once

#include <exception>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/protocol/log_limiter.hpp"
#include "physics/world.hpp"
#include "server/world_server/clock.hpp"
#include "server/world_server/options.hpp"
#include "server/world_server/session.hpp"

namespace kenaf::world_server {

inline constexpr std::size_t kMostRobots = 64;
inline constexpr std::uint64_t kMostBadLines = 1000;       // more, and the connection is closed
inline constexpr std::size_t kMostUnread_bytes = 8 << 20;  // likewise; a few minutes of a robot's complete reports

// An object made by CONTROL {Type Create}.
struct WorldObject {
  physics::BoxId box;
  std::string name, class_name;
  Eigen::Vector3d size_m;
  bool permanent;  // KillAll keeps it
};

// Who paused the world: an operator at a page, or a program, by its robot's name, or its address if it has none.
// Neither: unknown.
struct Pauser {
  OperatorId page{0};
  std::string program;
};

struct Simulation {
  // Throws std::runtime_error (DescriptionError) with a text for the user.
  explicit Simulation(const ServerOptions& options);

  // A client has connected; it is greeted. The session lives until disconnect().
  Session& connect(std::string peer);
  // A client has left, and its robot with it.
  void disconnect(Session& session);
  // Bytes from a client: whole lines are executed at once, or kept for the frame they are meant for. Ignored if the
  // session is to be closed. Returns true if the turn of this client is over before its lines are: call again, without
  // bytes, after others had theirs.
  bool receive(Session& session, std::string_view bytes, double wall_s);
  // Nothing has been heard of the client's machine for `unheard_s`, in wall-clock time. From options.peer_silence_s on
  // its robot is stopped, until the next command.
  void note_peer(Session& session, double unheard_s);
  // A robot leaves with its session: at once, although the connection is closed only later.
  void end(Session& session);

  struct Progress {
    bool stepped = false;          // call again at once
    std::optional<double> wake_s;  // otherwise: call at this wall-clock time, or when something is received
  };
  // Sends the outputs due, and runs one step of the world if allowed. Whatever fails, memory above all, ends a session,
  // and neither throws nor concerns the others: the session for which it was done, or, if the step itself failed, that
  // of the robot placed last.
  //
  // Steps that nobody sees happen may be made together, up to 5 ms late: the wake-up is for the next output or
  // call_at().
  Progress advance(double wall_s);
  // Makes the steps that are due since such a wake-up was named, at most 20. To be called before anything from outside
  // is carried out, which would otherwise take effect before them. Fails like advance().
  void catch_up(double wall_s);

  // Returns the description for a class name; nullptr if there is none (logged).
  const physics::RobotDescription* description_for_class(std::string_view class_name);
  // Returns the command of a newly placed robot of this description: at rest, flippers at their start angles.
  static robot::Command resting_command(const physics::RobotDescription& description);
  // Returns the initial fields of view of its cameras.
  static std::vector<double> unzoomed(const physics::RobotDescription& description);
  std::size_t robot_count() const;
  // The only way to command: passes the command in force for the session's robot to the world, its client's or its
  // holder's.
  void apply_command(const Session& session);
  std::uint64_t steps_for(double robot_time_s) const;
  Session* find_session(std::uint32_t id);  // nullptr: it has ended

  // CONTROL {Type Step}: runs this many steps, then pauses and answers. `session`: the session to answer; 0: none.
  // Returns false if the queue of steps is full.
  bool begin_steps(std::uint32_t session, std::uint64_t steps, Pauser by = {});
  // Calls `then` once, when the world has made `step` steps in total: at once if it already has. Earlier if the world
  // is reset, because time restarts. Replaces the previous request of the same owner. The world waits for the call,
  // which must take only microseconds.
  void call_at(const void* owner, std::uint64_t step, std::function<void(Simulation&)> then);

  // CONTROL {Type Reset}
  void reset();
  // Pauses or resumes, and informs every client that understands it. A world that is paused keeps its first `by`.
  void set_paused(bool paused, Pauser by = {});

  const ServerOptions options;
  const Dialect dialect;
  physics::World world;
  Clock clock;
  std::vector<std::unique_ptr<Session>> sessions;  // in order of connection
  std::vector<WorldObject> objects;
  const std::vector<physics::BoxId> loose_boxes;  // the movable ones of the world's description
  std::vector<physics::SensorSample> samples;     // reused by every output
  double wall_s = 0;                              // of the present call
  Pauser pauser;                                  // while the clock is paused
  protocol::LogLimiter connection_log{20, 0.5};   // for robots that come and go

 private:
  static constexpr std::uint64_t kNever = std::numeric_limits<std::uint64_t>::max();

  struct StepRequest {
    std::uint32_t session;
    std::uint64_t until_step;
  };

  struct Call {
    const void* owner;
    std::uint64_t step;
    std::function<void(Simulation&)> then;
  };

  void call_due(std::uint64_t step);
  bool handle_line(Session& session, std::string_view line, int& cost);
  void send_due(Session& session);
  // Carries out what concerns this session; ends it if that throws.
  template <typename Work>
  void attempt(Session& session, Work work);
  void end_newest_robot(const std::exception& failure);
  void watch_silence(Session& session);
  void answer_steps();
  void tell_fault(Session& session);
  void tell_of_crowd();
  bool held_by_lockstep(std::optional<double>& until_wall_s);
  std::uint64_t steps_to_next_event() const;

  std::map<std::string, physics::RobotDescription, std::less<>> descriptions_;  // by shipped name or file
  std::vector<StepRequest> step_requests_;
  std::vector<Call> calls_;
  std::uint64_t next_call_step_ = kNever;
  std::uint64_t steps_left_ = 0;  // to be made together at the next wake-up
  std::uint32_t last_session_ = 0;
  std::string deferred_lines_;  // scratch of send_due()
  protocol::LogLimiter behind_log_{1, 10};
  protocol::LogLimiter fault_log_{kMostRobots, 5};
  protocol::LogLimiter crowd_log_{1, 10};
  std::uint64_t pairs_left_out_ = 0;  // as last seen
  double dropped_s_ = 0;              // robot time by which this machine lags
  bool idle_ = true;                  // time was stopped at the last call
};

}  // namespace kenaf::world_server
