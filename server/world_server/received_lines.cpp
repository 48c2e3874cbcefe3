// How Simulation takes what clients send: line by line, each at once or with the frame that it answers.
#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "server/world_server/simulation.hpp"
#include "server/world_server/verbs.hpp"

namespace kenaf::world_server {

namespace {

// Limit on lines kept for the next frame; a correct client sends one or two.
constexpr std::size_t kMostDeferredBytes = 65536;

// Closes a session whose first bytes are those of another protocol.
void refuse_foreign(Simulation& simulation, Session& session, std::string_view bytes) {
  const std::string_view protocol = session.opening.take(bytes);
  if (protocol.empty()) return;
  session.close = true;
  if (simulation.connection_log.allow(simulation.wall_s)) {
    spdlog::warn("{}: closed: it speaks {}, not USARSim", session.peer, protocol);
  }
}

bool is_word(std::string_view text) {
  return std::ranges::all_of(text, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  });
}

}  // namespace

bool Simulation::receive(Session& session, std::string_view bytes, double now_wall_s) {
  wall_s = now_wall_s;
  session.peer_silent = false;
  if (session.close) return false;
  refuse_foreign(*this, session, bytes);
  if (session.close) return false;
  if (!session.lines.push(bytes)) {
    ++session.bad_lines;
    complain(*this, session, "a line is longer than 64 KiB", "");
  }
  int cost = 0;  // of this turn so far
  const std::string kept = std::exchange(session.next_line, {});
  for (std::optional<std::string_view> line = kept.empty() ? session.lines.next() : kept; line;
       line = session.lines.next()) {
    if (!handle_line(session, *line, cost)) {
      session.next_line = *line;
      return true;
    }
    if (session.bad_lines > kMostBadLines) {
      spdlog::warn("{}: closed after {} lines that are not USARSim messages", session.peer, session.bad_lines);
      session.close = true;
    }
    // Checked per line: a packet may hold hundreds of requests with long answers, and executing them all would stall
    // the world.
    if (session.out.size() > kMostUnread_bytes) {
      spdlog::warn("{}: closed: more than {} MiB of messages to it are waiting", session.peer, kMostUnread_bytes >> 20);
      session.close = true;
    }
    if (session.close) return false;
  }
  return false;
}

// Returns false, without executing the line, if it would cost more than what is left of this turn.
bool Simulation::handle_line(Session& session, std::string_view line, int& cost) {
  // Garbage is counted: receive() closes a connection that sends too much of it.
  MessageView message;
  const protocol::usarsim::ParseError error = protocol::usarsim::parse_message(line, message);
  if (error == protocol::usarsim::ParseError::empty) return true;
  const bool readable = protocol::usarsim::is_readable(error);
  if (!readable || !is_word(message.type)) {
    ++session.bad_lines;
    complain(*this, session, readable ? "not a USARSim message" : protocol::usarsim::describe(error), line);
    return true;
  }
  // What an odd line has all the same is obeyed.
  if (error != protocol::usarsim::ParseError::none) {
    complain(*this, session, protocol::usarsim::describe(error), line);
  }
  const VerbEntry* entry = find_verb(message);
  if (entry == nullptr) {
    complain(*this, session, "an unknown verb is ignored", line);
    return true;
  }
  if (cost > 0 && cost + cost_of(message) > kMostCost) return false;
  cost += cost_of(message);

  // An answer to a numbered frame: in time, it is kept until the next frame begins; late, it takes effect at once; a
  // frame that was not sent yet cannot be answered.
  const auto frame = number_of(message, "Frame");
  if (entry->takes_frame && frame && session.schedule.numbered()) {
    if (!(*frame >= 0 && *frame < 1e15)) {
      complain(*this, session, "no such frame", line);
      return true;
    }
    switch (session.schedule.take_answer(static_cast<std::uint64_t>(*frame), message.is("DRIVE"))) {
      case FrameSchedule::Answer::in_time:
        if (session.deferred.size() + line.size() > kMostDeferredBytes) {
          complain(*this, session, "too many commands for one frame", line);
          return true;
        }
        session.deferred.append(line).push_back('\n');
        return true;
      case FrameSchedule::Answer::ahead:
        complain(*this, session, "answers a frame that was not sent yet", line);
        return true;
      case FrameSchedule::Answer::late:
        break;
    }
  }

  // All others take effect at once.
  entry->verb(*this, session, message);
  return true;
}

}  // namespace kenaf::world_server
