#include "server/world_server/verbs.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>

namespace kenaf::world_server {

namespace {

constexpr std::array kVerbs = {
    VerbEntry{"DRIVE", drive, true},
    VerbEntry{"MULTIDRIVE", multi_drive, true},
    VerbEntry{"SET", set, true},
    VerbEntry{"MISPKG", move_mission_package, true},
    VerbEntry{"ACT", move_mission_package, true},
    VerbEntry{"PING", ping, false},
    VerbEntry{"INIT", init, false},
    VerbEntry{"GETSTARTPOSES", get_start_poses, false},
    VerbEntry{"GETGEO", get_geometry, false},
    VerbEntry{"GETCONF", get_configuration, false},
    VerbEntry{"CONTROL", control, false},
};

}  // namespace

const VerbEntry* find_verb(const MessageView& message) {
  const auto found = std::ranges::find_if(kVerbs, [&](const VerbEntry& entry) { return message.is(entry.name); });
  return found == kVerbs.end() ? nullptr : &*found;
}

int cost_of(const MessageView& message) {
  if (message.is("INIT")) return kMostCost;
  if (!message.is("CONTROL")) return 0;
  const std::string_view type = text_of(message, "Type");
  // All is built anew, or every object is looked at.
  if (is_any_of(type, {"Reset", "KillAll"})) return kMostCost;
  // A robot is lifted until it is free.
  if (is_any_of(type, {"AbsMove", "RelMove"})) return kMostCost / 4;
  return is_any_of(type, {"Create", "Kill", "GetSTA"}) ? 1 : 0;
}

std::string_view text_of(const MessageView& message, std::string_view key) {
  return message.find(key).value_or(std::string_view());
}

std::optional<double> number_of(const MessageView& message, std::string_view key) {
  return protocol::usarsim::parse_number(text_of(message, key));
}

std::optional<bool> bool_of(const MessageView& message, std::string_view key) {
  return protocol::usarsim::parse_bool(text_of(message, key));
}

bool is_any_of(std::string_view text, std::initializer_list<std::string_view> words) {
  return std::ranges::any_of(
      words, [text](std::string_view word) { return protocol::usarsim::equal_ignoring_case(text, word); });
}

std::string printable(std::string_view text) {
  constexpr std::size_t kLongest = 64;
  std::string out(text.substr(0, kLongest));
  std::ranges::replace_if(
      out, [](char c) { return c < ' ' || c > '~' || c == '{' || c == '}'; }, '?');
  if (text.size() > kLongest) out += "...";
  return out;
}

void complain(const Simulation& simulation, Session& session, std::string_view what, std::string_view text) {
  const auto suppressed = session.bad_line_log.allow(simulation.wall_s);
  if (!suppressed) return;
  spdlog::warn("{}: {}: \"{}\" ({} more since the last such line)", session.peer, what, printable(text), *suppressed);
}

void write_answer(const Simulation& simulation, Session& session, std::string_view type, std::string_view name,
                  Reason reason, bool with_reason) {
  protocol::usarsim::MessageWriter writer(session.out);
  writer.begin("RES").number("Time", simulation.world.time_s(), session.formats.sensor_time);
  writer.text("Type", printable(type)).text("Name", printable(name));
  writer.text("Status", reason.empty() ? "OK" : "Failed");
  if (with_reason) writer.text("Reason", reason);
  writer.end();
}

void answer(const Simulation& simulation, Session& session, std::string_view type, std::string_view name,
            Reason reason) {
  write_answer(simulation, session, type, name, reason, session.extended);
  if (!reason.empty() && !session.extended) complain(simulation, session, reason, fmt::format("{} {}", type, name));
}

}  // namespace kenaf::world_server
