// Requests of a client, one function per verb. Each executes `message` for `session`, and writes its answer, if the
// protocol has one, to session.out. Requests that cannot be executed are ignored, as in USARSim, with at most one log
// line in five seconds.
#pragma once

#include <cstdint>
#include <string_view>

#include "formats/protocol/usarsim_message.hpp"
#include "server/world_server/simulation.hpp"

namespace kenaf::world_server {

using protocol::usarsim::MessageView;

using Verb = void (*)(Simulation&, Session&, const MessageView&);
struct VerbEntry {
  std::string_view name;
  Verb verb;
  bool takes_frame;  // may carry {Frame n}
};
// nullptr if there is no such verb.
const VerbEntry* find_verb(const MessageView& message);

// Requests that may take milliseconds share a turn of their connection: those beyond kMostCost wait for its next turn,
// so that the world and other connections go on in between.
inline constexpr int kMostCost = 32;
int cost_of(const MessageView& message);  // 0 to kMostCost

// verbs_session.cpp
void init(Simulation&, Session&, const MessageView&);
void get_start_poses(Simulation&, Session&, const MessageView&);
// verbs_drive.cpp
void drive(Simulation&, Session&, const MessageView&);
void multi_drive(Simulation&, Session&, const MessageView&);
// verbs_set.cpp
void set(Simulation&, Session&, const MessageView&);
void move_mission_package(Simulation&, Session&, const MessageView&);  // MISPKG, ACT
// verbs_control.cpp
void control(Simulation&, Session&, const MessageView&);
void ping(Simulation&, Session&, const MessageView&);
// verbs_world.cpp: CONTROL's requests about objects; returns false if `type` is none of them
bool control_world(Simulation&, Session&, const MessageView&, std::string_view type);
// report_geometry.cpp
void get_geometry(Simulation&, Session&, const MessageView&);
void get_configuration(Simulation&, Session&, const MessageView&);

using Reason = std::string_view;  // why a verb failed
constexpr Reason kDone;           // it succeeded

// Returns the value of `key`, "" if it is missing.
std::string_view text_of(const MessageView& message, std::string_view key);
std::optional<double> number_of(const MessageView& message, std::string_view key);
std::optional<bool> bool_of(const MessageView& message, std::string_view key);
bool is_any_of(std::string_view text, std::initializer_list<std::string_view> words);  // without case
// Makes a client's text safe for a log line or an answer: printable, at most 64 characters.
std::string printable(std::string_view text);

inline constexpr std::string_view kNoRobotYet = "a command before INIT placed a robot is ignored";

// Warns about a client's input `text`: the first warning is logged, further ones within 5 s are counted.
void complain(const Simulation&, Session&, std::string_view what, std::string_view text);

// RES {Time t} {Type type} {Name name} {Status OK}, or {Status Failed} if a reason is given. USARSim gave no reasons,
// and its clients' parsers fail on groups that they do not know: {Reason reason} is for clients that know this server.
void write_answer(const Simulation&, Session&, std::string_view type, std::string_view name, Reason reason,
                  bool with_reason);
// The same to a request, with the reason for a client with a Session; the log has it for any other.
void answer(const Simulation&, Session&, std::string_view type, std::string_view name, Reason reason = kDone);

}  // namespace kenaf::world_server
