#include "server/world_server/simulation.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "physics/terrain_effects.hpp"
#include "server/world_server/manual_drive.hpp"
#include "server/world_server/report.hpp"
#include "server/world_server/verbs.hpp"

namespace kenaf::world_server {

namespace {

// Default timers of the historic servers: UT2004's msgTimer, measured 0.2 s; UDK's StatusTimer 0.1 s.
double default_period_s(Dialect dialect) {
  return dialect == Dialect::ut2004 ? 0.2 : 0.1;
}

physics::World make_world(const ServerOptions& options) {
  if (!(options.time_step_s > 0 && options.time_step_s <= 0.02)) {
    throw std::runtime_error(
        fmt::format("a time step of {} s: choose more than 0 and at most 0.02 s", options.time_step_s));
  }
  std::vector<std::string> unsupported;
  const physics::WorldDescription nominal = physics::load_world(options.world, unsupported);
  for (const std::string& element : unsupported) spdlog::warn("world {}: ignored: {}", options.world, element);
  physics::PhysicsSettings settings;
  settings.time_step_s = options.time_step_s;
  // There is one world, so it has the effects of --robot, whatever other robots join.
  const physics::Effects effects = physics::load_robot(options.robot).effects;
  return physics::World(physics::with_terrain_effects(nominal, effects), settings, options.seed);
}

std::vector<physics::BoxId> find_loose_boxes(const physics::World& world) {
  std::vector<physics::BoxId> boxes = world.boxes();
  std::erase_if(boxes, [&](physics::BoxId id) { return world.box(id).mass_kg == 0; });
  return boxes;
}

}  // namespace

Simulation::Simulation(const ServerOptions& server_options)
    : options(server_options),
      dialect(server_options.udk_dialect ? Dialect::udk : Dialect::ut2004),
      world(make_world(server_options)),
      clock(server_options.time_step_s, server_options.speed),
      loose_boxes(find_loose_boxes(world)) {
  if (!(options.speed >= 0 && std::isfinite(options.speed))) {
    throw std::runtime_error("the speed is a factor of real time, 0 or more (0: as fast as possible)");
  }
  // Loaded now, so that a wrong file fails at the start and not at a client's INIT.
  descriptions_.emplace(options.robot, physics::load_robot(options.robot));
}

Session& Simulation::connect(std::string peer) {
  auto session = std::make_unique<Session>();  // joins the others when it is whole
  session->id = last_session_ + 1;
  session->peer = std::move(peer);
  session->formats = formats_of(dialect);
  session->schedule.start(0, steps_for(default_period_s(dialect)), false);
  protocol::usarsim::MessageWriter(session->out)
      .begin("NFO")
      .text("Gametype", "BotDeathMatch")
      .text("Level", world.description().name)
      .integer("TimeLimit", 20)
      .end();
  sessions.push_back(std::move(session));
  ++last_session_;
  return *sessions.back();
}

void Simulation::end(Session& session) {
  session.close = true;
  if (!session.robot) return;
  world.remove_robot(session.robot->id);
  if (connection_log.allow(wall_s)) spdlog::info("{}: robot {} left", session.peer, session.robot->name);
  session.hold.reset();
  session.robot.reset();
}

void Simulation::disconnect(Session& session) {
  end(session);
  std::erase_if(sessions, [&](const auto& other) { return other.get() == &session; });
}

void Simulation::note_peer(Session& session, double unheard_s) {
  const bool was_silent = session.peer_silent;
  session.peer_silent = options.peer_silence_s > 0 && unheard_s > options.peer_silence_s;
  if (!session.peer_silent || was_silent || !session.robot) return;
  spdlog::warn("{}: its machine has not answered for {:.1f} s: robot {} is stopped", session.peer, unheard_s,
               session.robot->name);
}

void Simulation::send_due(Session& session) {
  if (!session.robot) return;
  watch_operator(*this, session);
  if (session.placed_by_operator) return session.out.clear();
  const std::uint64_t step = world.step_count();
  if (!session.schedule.due(step)) return watch_silence(session);

  // Executes the commands for the frame that begins now.
  deferred_lines_.clear();
  std::swap(deferred_lines_, session.deferred);
  for (std::string_view rest = deferred_lines_; !rest.empty();) {
    const std::size_t end = rest.find('\n');
    MessageView message;
    protocol::usarsim::parse_message(rest.substr(0, end), message);
    if (const VerbEntry* entry = find_verb(message)) entry->verb(*this, session, message);
    rest.remove_prefix(end + 1);
  }
  watch_silence(session);

  session.schedule.begin_frame(step);
  write_sensors(*this, session);
  write_mission_packages(*this, session);
  write_status(*this, session);
}

template <typename Work>
void Simulation::attempt(Session& session, Work work) {
  try {
    work(session);
  } catch (const std::exception& failure) {
    spdlog::error("{}: closed: its robot cannot be served: {}", session.peer, failure.what());
    end(session);
    std::string().swap(session.out);  // gives its memory back
    std::string().swap(session.deferred);
  }
}

void Simulation::end_newest_robot(const std::exception& failure) {
  const auto newest =
      std::ranges::find_if(sessions.rbegin(), sessions.rend(), [](const auto& s) { return s->robot.has_value(); });
  if (newest == sessions.rend()) {
    spdlog::error("the world cannot be stepped: {}", failure.what());
    step_requests_.clear();
    return;
  }
  spdlog::error("{}: closed: the world cannot be stepped with its robot: {}", (*newest)->peer, failure.what());
  end(**newest);
}

void Simulation::watch_silence(Session& session) {
  const bool timed_out = session.command_timeout_steps != 0 &&
                         world.step_count() >= session.last_command_step + session.command_timeout_steps;
  if (!timed_out && !session.peer_silent) return;
  session.silent = true;
  if (!session.stop.due(world.step_count())) return;
  SessionRobot& robot = *session.robot;
  robot.command.track_speed_mps = {};
  forget_curve(robot);
  // A flipper with a speed or torque command would continue; one with an angle command holds it.
  for (robot::JointCommand& joint : robot.command.flipper) {
    if (joint.mode != robot::JointMode::angle) joint = {robot::JointMode::brake, 0};
  }
  apply_command(session);
}

void Simulation::apply_command(const Session& session) {
  world.set_command(session.robot->id, session.hold ? session.hold->command : session.robot->command);
}

bool Simulation::held_by_lockstep(std::optional<double>& until_wall_s) {
  bool held = false;
  for (const auto& session : sessions) {
    if (!session->robot || !session->schedule.holds(world.step_count())) continue;
    if (session->schedule.let_go(wall_s, options.lockstep_wait_s)) {
      if (session->lockstep_log.allow(wall_s)) {
        spdlog::warn("{}: frame {} was not answered; time runs on without it", session->peer,
                     session->schedule.frame());
      }
      attempt(*session, [this](Session& late) { send_due(late); });
      continue;
    }
    held = true;
    const double until = session->schedule.holds_since_wall_s().value_or(wall_s) + options.lockstep_wait_s;
    until_wall_s = std::min(until, until_wall_s.value_or(until));
  }
  return held;
}

Simulation::Progress Simulation::advance(double now_wall_s) {
  wall_s = now_wall_s;
  const auto send_to_all = [this] {
    for (const auto& session : sessions) attempt(*session, [this](Session& one) { send_due(one); });
  };
  send_to_all();

  const bool stepping = !step_requests_.empty();
  if (!stepping && (clock.paused() || robot_count() == 0)) {
    idle_ = true;
    return {};
  }
  if (idle_) clock.skip(wall_s);
  idle_ = false;
  dropped_s_ += clock.pass(wall_s);
  if (!stepping && !clock.step_due()) {
    steps_left_ = steps_to_next_event();
    return {false, clock.step_wall_s(steps_left_)};
  }
  steps_left_ = 0;
  std::optional<double> until_wall_s;
  if (held_by_lockstep(until_wall_s)) {
    dropped_s_ = 0;  // the client causes the delay
    return {false, until_wall_s};
  }
  if (dropped_s_ > 0.5 * clock.speed() && behind_log_.allow(wall_s)) {
    spdlog::warn("this machine is too slow for {} times real time: robot time is {:.2f} s behind", clock.speed(),
                 dropped_s_);
    dropped_s_ = 0;
  }

  try {
    world.step();
  } catch (const std::exception& failure) {
    end_newest_robot(failure);
    return {true, std::nullopt};
  }
  if (!stepping) clock.stepped();
  if (world.step_count() >= next_call_step_) call_due(world.step_count());
  for (const auto& session : sessions) attempt(*session, [this](Session& one) { tell_fault(one); });
  answer_steps();
  send_to_all();
  tell_of_crowd();
  return {true, std::nullopt};
}

// A system of a thousand wake-ups a second spends most of its time on waking up. With more time or steps in one, a
// program's order would wait for a long burst.
std::uint64_t Simulation::steps_to_next_event() const {
  constexpr double kLongestSleep_s = 0.005;
  constexpr std::uint64_t kMostSteps = 20;
  const std::uint64_t now = world.step_count();
  std::uint64_t next = now + std::min(kMostSteps, steps_for(kLongestSleep_s * clock.speed()));
  next = std::min(next, next_call_step_);
  for (const auto& session : sessions)
    if (session->robot && !session->placed_by_operator) next = std::min(next, session->schedule.next_step());
  return std::max(next, now + 1) - now;
}

void Simulation::catch_up(double now_wall_s) {
  for (std::uint64_t left = std::exchange(steps_left_, 0); left > 0 && advance(now_wall_s).stepped; --left) {
  }
}

bool Simulation::begin_steps(std::uint32_t session, std::uint64_t steps, Pauser by) {
  constexpr std::size_t kMostWaiting = 1000;
  if (step_requests_.size() >= kMostWaiting) return false;
  set_paused(true, std::move(by));
  const std::uint64_t from = step_requests_.empty() ? world.step_count() : step_requests_.back().until_step;
  step_requests_.push_back({session, from + steps});
  return true;
}

void Simulation::answer_steps() {
  while (!step_requests_.empty() && world.step_count() >= step_requests_.front().until_step) {
    const std::uint32_t asked_by = step_requests_.front().session;
    step_requests_.erase(step_requests_.begin());
    if (Session* session = find_session(asked_by)) {
      attempt(*session, [this](Session& one) { answer(*this, one, "Control", "Step"); });
    }
  }
}

void Simulation::tell_fault(Session& session) {
  if (!session.robot) return;
  SessionRobot& robot = *session.robot;
  const std::string& fault = world.fault(robot.id);
  const bool is_new = !fault.empty() && !robot.fault_reported;
  robot.fault_reported = !fault.empty();
  if (!is_new) return;
  if (fault_log_.allow(wall_s))
    spdlog::error(
        "{}: the simulation of robot {} failed: {}; the robot does not move until it is placed anew or the world is "
        "reset",
        session.peer, robot.name, fault);
  write_answer(*this, session, "Robot", robot.name, fault, session.extended);
}

void Simulation::tell_of_crowd() {
  const bool more = world.pairs_left_out() > pairs_left_out_;
  pairs_left_out_ = world.pairs_left_out();
  if (!more || !crowd_log_.allow(wall_s)) return;
  spdlog::warn("{} pairs of bodies are near each other, the most there may be: some boxes meet nothing but the ground",
               world.pair_count());
}

void Simulation::set_paused(bool paused, Pauser by) {
  if (clock.paused() == paused) return;
  clock.set_paused(paused);
  pauser = paused ? std::move(by) : Pauser{};
  // While time is stopped no output falls due, so a client would never learn the reason for the silence.
  for (const auto& session : sessions) {
    if (session->robot && session->extended && session->schedule.frame() > 0) write_status(*this, *session);
  }
}

void Simulation::call_at(const void* owner, std::uint64_t step, std::function<void(Simulation&)> then) {
  std::erase_if(calls_, [owner](const Call& call) { return call.owner == owner; });
  calls_.push_back({owner, step, std::move(then)});
  call_due(world.step_count());
}

// The calls may request further calls, which are added at the end and are not called here. One that fails keeps neither
// the others nor the world from going on.
void Simulation::call_due(std::uint64_t step) {
  const auto is_due = [step](const Call& call) { return call.step <= step; };
  for (auto left = std::ranges::count_if(calls_, is_due); left > 0; --left) {
    const auto due = std::ranges::find_if(calls_, is_due);
    if (due == calls_.end()) break;
    const Call call = std::move(*due);
    calls_.erase(due);
    try {
      call.then(*this);
    } catch (const std::exception& failure) {
      spdlog::error("a call at step {} failed: {}", call.step, failure.what());
    }
  }
  next_call_step_ = kNever;
  for (const Call& call : calls_) next_call_step_ = std::min(next_call_step_, call.step);
}

void Simulation::reset() {
  // The world's time is 0 again; pending step requests are answered as failed.
  world.reset();
  for (const StepRequest& request : step_requests_) {
    if (Session* session = find_session(request.session)) {
      answer(*this, *session, "Control", "Step", "the world was reset");
    }
  }
  step_requests_.clear();

  // Each connection restarts: frames from step 0, no deferred commands, no silence.
  for (const auto& session : sessions) {
    session->deferred.clear();
    session->last_command_step = 0;
    session->silent = false;
    session->stop.over();
    session->schedule.restart_at(0);
    if (!session->robot) continue;

    // Each robot gets its resting command and initial fields of view; an operator's hold continues, stopped.
    session->robot->command = resting_command(*session->robot->description);
    forget_curve(*session->robot);
    session->robot->normalized = false;
    session->robot->camera_field_of_view_rad = unzoomed(*session->robot->description);
    if (session->hold) {
      session->hold->command = standing_command();
      session->hold->stop.over();
    }
    apply_command(*session);
  }

  // Pending calls refer to the old time: make all of them now.
  call_due(kNever);
}

const physics::RobotDescription* Simulation::description_for_class(std::string_view class_name) {
  std::string name = physics::robot_name_for_class(class_name);
  if (name.empty()) return nullptr;
  if (name == "kenaf") name = options.robot;
  auto found = descriptions_.find(name);
  if (found == descriptions_.end()) {
    try {
      found = descriptions_.emplace(name, physics::load_robot(name)).first;
    } catch (const std::runtime_error& error) {
      spdlog::error("{}", error.what());
      return nullptr;
    }
  }
  return &found->second;
}

robot::Command Simulation::resting_command(const physics::RobotDescription& description) {
  robot::Command command;
  if (description.has_flippers()) {
    command.flipper.fill({robot::JointMode::angle, description.flipper.front().start_angle_rad});
  }
  return command;
}

std::vector<double> Simulation::unzoomed(const physics::RobotDescription& description) {
  std::vector<double> angles_rad;
  for (const physics::CameraDescription& camera : description.cameras) angles_rad.push_back(camera.field_of_view_rad);
  return angles_rad;
}

std::size_t Simulation::robot_count() const {
  return static_cast<std::size_t>(
      std::ranges::count_if(sessions, [](const auto& session) { return session->robot.has_value(); }));
}

std::uint64_t Simulation::steps_for(double robot_time_s) const {
  return static_cast<std::uint64_t>(std::max(1LL, std::llround(robot_time_s / world.settings().time_step_s)));
}

Session* Simulation::find_session(std::uint32_t id) {
  const auto found = std::ranges::find_if(sessions, [id](const auto& session) { return session->id == id; });
  return found == sessions.end() ? nullptr : found->get();
}

}  // namespace kenaf::world_server
