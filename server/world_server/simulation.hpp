// A world with its clients: everything the world server does, without sockets and without a clock of its own.
//
// Thread safety: none; one thread owns a Simulation. Wall-clock time comes in as an argument: seconds of a steady
// clock.
#pragma once

#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "physics/world.hpp"
#include "server/world_server/clock.hpp"
#include "server/world_server/options.hpp"
#include "server/world_server/session.hpp"

namespace kenaf::world_server {

inline constexpr std::size_t kMostRobots = 64;
inline constexpr std::uint64_t kMostBadLines = 1000;       // then the connection is closed
inline constexpr std::size_t kMostUnread_bytes = 8 << 20;  // likewise; a few minutes of everything a robot reports

// What CONTROL {Type Create} made.
struct WorldObject {
  physics::BoxId box;
  std::string name, class_name;
  Eigen::Vector3d size_m;
  bool permanent;  // KillAll leaves it
};

struct Simulation {
  // Throws std::runtime_error (DescriptionError) in words.
  explicit Simulation(const ServerOptions& options);

  // A client came; it is greeted. The session lives until disconnect().
  Session& connect(std::string peer);
  // It left, and its robot with it.
  void disconnect(const Session& session);
  // Bytes from a client: its whole lines are obeyed at once, or kept for the frame they are meant for. One whose
  // session is to be closed is not obeyed any more.
  void receive(Session& session, std::string_view bytes, double wall_s);

  struct Progress {
    bool stepped = false;          // call again at once
    std::optional<double> wake_s;  // otherwise: at this wall-clock time, or when something is received
  };
  // Sends what is due, and runs one step of the world where it may run.
  Progress advance(double wall_s);

  // The description that a class name stands for; nullptr: there is none (said in the log).
  const physics::RobotDescription* description_for_class(std::string_view class_name);
  // The command that a robot of this description has when it is placed: at rest, flippers where they start.
  static robot::Command resting_command(const physics::RobotDescription& description);
  // The angles of view that its cameras have then.
  static std::vector<double> unzoomed(const physics::RobotDescription& description);
  std::size_t robot_count() const;
  // The one way to command: tells the world what is in force for the session's robot: the client's, or that of who
  // holds it.
  void apply_command(const Session& session);
  std::uint64_t steps_for(double robot_time_s) const;
  Session* find_session(std::uint32_t id);  // nullptr: it is gone

  // CONTROL {Type Step}: runs on for so many steps, then stands still and answers.
  // `session`: whom to answer when it is done; 0: nobody. False: as many wait already as are taken.
  bool begin_steps(std::uint32_t session, std::uint64_t steps);
  // Calls `then` once, as soon as the world has made `step` steps in all: at once where it has. Earlier where the world
  // is reset, as time begins anew. It takes the place of what the same owner asked for before. The world waits for it:
  // microseconds.
  void call_at(const void* owner, std::uint64_t step, std::function<void(Simulation&)> then);

  // CONTROL {Type Reset}
  void reset();
  // Pauses or resumes, and says so to every client that understands it.
  void set_paused(bool paused);

  const ServerOptions options;
  const Dialect dialect;
  physics::World world;
  Clock clock;
  std::vector<std::unique_ptr<Session>> sessions;  // in the order of their coming
  std::vector<WorldObject> objects;
  const std::vector<physics::BoxId> loose_boxes;  // of the world's description, those that may move
  std::vector<physics::SensorSample> samples;     // reused by every output
  double wall_s = 0;                              // of the call that is being worked on
  LogLimiter connection_log{20, 0.5};             // robots that come and go

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
  void handle_line(Session& session, std::string_view line);
  void send_due(Session& session);
  void watch_silence(Session& session);
  void answer_steps();
  void tell_faults();
  bool held_by_lockstep(std::optional<double>& until_wall_s);

  std::map<std::string, physics::RobotDescription, std::less<>> descriptions_;  // by shipped name or file
  std::vector<StepRequest> step_requests_;
  std::vector<Call> calls_;
  std::uint64_t next_call_step_ = kNever;
  std::uint32_t last_session_ = 0;
  std::string due_lines_;  // scratch of send_due()
  LogLimiter behind_log_{1, 10};
  LogLimiter fault_log_{kMostRobots, 5};
  double dropped_s_ = 0;  // robot time that this machine is behind
  bool idle_ = true;      // time stood still at the last call
};

}  // namespace kenaf::world_server
