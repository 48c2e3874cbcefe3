// CONTROL's requests about time and the connection itself, and PING. docs/world-server-protocol.md, Extensions.
#include <spdlog/spdlog.h>

#include <cmath>

#include "server/world_server/verbs.hpp"

namespace kenaf::world_server {

namespace {

constexpr double kLongestStep_s = 3600;
constexpr double kLongestPeriod_s = 10;
constexpr double kLongestCommandTimeout_s = 3600;
constexpr double kMostDecimals = 15;
constexpr std::size_t kLongestOwner = 64;

Pauser pauser_of(const Session& session) {
  return {OperatorId{0}, session.robot ? session.robot->name : session.peer};
}

Reason step(Simulation& simulation, Session& session, const MessageView& message) {
  const double most_steps = std::floor(kLongestStep_s / simulation.world.settings().time_step_s);
  double steps = 0;
  if (const auto time_s = number_of(message, "Time")) {
    if (!(*time_s > 0 && *time_s <= kLongestStep_s)) return "Time is not more than 0 and at most 3600 s";
    steps = static_cast<double>(simulation.steps_for(*time_s));
  } else if (const auto count = number_of(message, "Steps")) {
    steps = std::floor(*count);
  }
  if (!(steps >= 1 && steps <= most_steps)) return "needs {Time s} or {Steps n}, at most an hour of robot time";
  if (!simulation.begin_steps(session.id, static_cast<std::uint64_t>(steps), pauser_of(session)))
    return "1000 steps are waiting already";
  return kDone;
}

Reason set_speed(Simulation& simulation, const Session& session, const MessageView& message) {
  const auto speed = number_of(message, "Value");
  if (!speed || !(*speed == 0 || (*speed >= 1e-3 && *speed <= 1e6))) return "Value is not 0 or from 0.001 to 1000000";
  simulation.clock.set_speed(*speed);
  spdlog::debug("{}: speed {}", session.peer, *speed);
  return kDone;
}

// A client that lost its connection and comes back takes the place of its old one, whose end the server may not have
// seen yet.
void replace_others_of(Simulation& simulation, const Session& session) {
  for (const auto& other : simulation.sessions) {
    if (other.get() == &session || other->close || other->owner != session.owner) continue;
    spdlog::info("{}: closed: {} replaces it", other->peer, session.peer);
    simulation.end(*other);
  }
}

// A key that is present must be valid; nothing is changed unless all are.
template <typename Value>
bool reads(const MessageView& message, std::string_view key, std::optional<Value> value, double least, double most) {
  if (!message.find(key)) return true;
  return value && static_cast<double>(*value) >= least && static_cast<double>(*value) <= most;
}

Reason set_session(Simulation& simulation, Session& session, const MessageView& message) {
  // Read and check all keys before any of them takes effect.
  const auto period_s = number_of(message, "Period");
  const auto lockstep = bool_of(message, "Lockstep");
  const auto timeout_s = number_of(message, "CommandTimeout");
  const auto precision = number_of(message, "Precision");
  if (!reads(message, "Period", period_s, 1e-6, kLongestPeriod_s)) return "Period is not from 0.000001 to 10 s";
  if (!reads(message, "Lockstep", lockstep, 0, 1)) return "Lockstep is neither True nor False";
  if (!reads(message, "CommandTimeout", timeout_s, 0, kLongestCommandTimeout_s)) {
    return "CommandTimeout is not from 0 to 3600 s";
  }
  if (!reads(message, "Precision", precision, 0, kMostDecimals)) return "Precision is not from 0 to 15 digits";
  const std::string_view owner = text_of(message, "Owner");
  if (message.find("Owner") && (owner.empty() || owner.size() > kLongestOwner)) return "Owner is not 1 to 64 bytes";

  // From here on the client uses the extensions. A period starts numbered frames and drops deferred commands; the
  // command time-out counts from now.
  session.extended = true;
  const std::uint64_t now = simulation.world.step_count();
  if (precision) session.formats = formats_with(static_cast<int>(*precision));
  if (lockstep) session.schedule.set_lockstep(*lockstep);
  if (timeout_s) {
    session.command_timeout_steps = *timeout_s > 0 ? simulation.steps_for(*timeout_s) : 0;
    session.last_command_step = now;
  }
  if (period_s) {
    session.schedule.start(now, simulation.steps_for(*period_s), true);
    session.deferred.clear();
  }
  if (!owner.empty()) {
    session.owner = owner;
    replace_others_of(simulation, session);
  }
  return kDone;
}

void answer_session(const Simulation& simulation, Session& session) {
  protocol::usarsim::MessageWriter(session.out)
      .begin("RES")
      .number("Time", simulation.world.time_s(), session.formats.sensor_time)
      .text("Type", "Control")
      .text("Name", "Session")
      .text("Status", "OK")
      .number("Period", static_cast<double>(session.schedule.period_steps()) * simulation.world.settings().time_step_s,
              session.formats.value)
      .boolean("Lockstep", session.schedule.numbered() && session.schedule.lockstep())  // it waits only for frames
      .end();
}

}  // namespace

void control(Simulation& simulation, Session& session, const MessageView& message) {
  const std::string_view type = text_of(message, "Type");
  if (control_world(simulation, session, message, type)) return;

  Reason reason = kDone;
  if (is_any_of(type, {"Pause"})) {
    simulation.set_paused(true, pauser_of(session));
  } else if (is_any_of(type, {"Resume"})) {
    simulation.set_paused(false);
  } else if (is_any_of(type, {"Step"})) {
    reason = step(simulation, session, message);
    if (reason.empty()) return;  // answered on completion
  } else if (is_any_of(type, {"Speed"})) {
    reason = set_speed(simulation, session, message);
  } else if (is_any_of(type, {"Reset"})) {
    simulation.reset();
  } else if (is_any_of(type, {"Session"})) {
    reason = set_session(simulation, session, message);
    if (reason.empty()) return answer_session(simulation, session);
    return write_answer(simulation, session, "Control", type, reason, true);  // who asks for one knows this server
  } else {
    reason = "this server has no such CONTROL";
  }
  answer(simulation, session, "Control", type, reason);
}

void ping(Simulation& simulation, Session& session, const MessageView& message) {
  protocol::usarsim::MessageWriter(session.out)
      .begin("PONG")
      .text("Id", printable(text_of(message, "Id")))
      .number("Time", simulation.world.time_s(), session.formats.sensor_time)
      .end();
}

}  // namespace kenaf::world_server
