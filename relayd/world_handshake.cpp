#include "relayd/world_handshake.hpp"

#include <fmt/format.h>

#include "formats/protocol/frames.hpp"

namespace kenaf::relayd {

namespace {

using namespace std::chrono_literals;
constexpr auto kGreetingWithin = 1s;
constexpr auto kRobotWithin = 3s;
constexpr auto kRestWithin = 500ms;  // STA after RES, or RES after STA

bool has_value(const protocol::usarsim::MessageView& message, std::string_view key, std::string_view value) {
  const auto found = message.find(key);
  return found && protocol::usarsim::equal_ignoring_case(*found, value);
}

}  // namespace

std::optional<SessionAnswer> read_session_answer(const protocol::usarsim::MessageView& message) {
  if (!message.is("RES") || !has_value(message, "Type", "Control") || !has_value(message, "Name", "Session")) {
    return std::nullopt;
  }
  SessionAnswer answer;
  if (has_value(message, "Status", "Failed")) {
    answer.refusal = message.find("Reason").value_or("no reason given");
    return answer;
  }
  if (!has_value(message, "Status", "OK")) return std::nullopt;
  const auto number = [&](std::string_view key, double otherwise) {
    const auto text = message.find(key);
    return text ? protocol::usarsim::parse_number(*text).value_or(otherwise) : otherwise;
  };
  answer.ready.robot_time_s = number("Time", 0);
  answer.ready.period_s = number("Period", answer.ready.period_s);
  const auto lockstep = message.find("Lockstep");
  answer.ready.lockstep = lockstep && protocol::usarsim::parse_bool(*lockstep).value_or(false);
  return answer;
}

WorldHandshake::WorldHandshake(const RobotPlacement& placement, const WorldSession& session, TimePoint connected)
    : placement_(placement), session_(session), deadline_(connected + kGreetingWithin) {}

void WorldHandshake::on_message(const protocol::usarsim::MessageView& message, bool is_frame, TimePoint now,
                                std::string& out) {
  if (result_ != Result::pending) return;
  if (!greeted_) {
    if (message.is("NFO")) place(now, out);
  } else if (const auto answer = read_session_answer(message)) {
    if (!answer->refusal.empty()) return fail("it refused the session: " + answer->refusal);
    accepted_ = true;
    ready_ = answer->ready;
    deadline_ = now + kRestWithin;
  } else if (message.is("CONF") && has_value(message, "Type", "Encoder")) {
    has_calibration_ = true;
  } else if (is_frame) {
    if (!has_robot_) deadline_ = now + kRestWithin;
    has_robot_ = true;
  }
  if (accepted_ && has_calibration_ && has_robot_) result_ = Result::extended;
}

void WorldHandshake::on_time(TimePoint now, std::string& out) {
  if (result_ != Result::pending || now < deadline_) return;
  if (!greeted_) {
    place(now, out);
  } else if (has_robot_) {
    result_ = accepted_ ? Result::extended : Result::plain;
  } else {
    fail(fmt::format("it placed no robot of class '{}' (no STA after INIT); its log may say why",
                     placement_.class_name));
  }
}

void WorldHandshake::place(TimePoint now, std::string& out) {
  greeted_ = true;
  deadline_ = now + kRobotWithin;
  write_world_session(out, session_, placement_.owner);
  protocol::usarsim::MessageWriter writer(out);
  writer.begin("INIT").text("ClassName", placement_.class_name).text("Name", placement_.name);
  if (placement_.pose) {
    const auto& [x, y, z, roll, pitch, yaw] = *placement_.pose;
    writer.numbers("Location", protocol::frames::usarsim_vector_from_rep103({x, y, z}),
                   protocol::usarsim::kExactNumber);
    writer.numbers("Rotation", protocol::frames::usarsim_angles_from_rep103({roll, pitch, yaw}),
                   protocol::usarsim::kExactNumber);
  } else if (!placement_.start.empty()) {
    writer.text("Start", placement_.start);
  }
  writer.end();
  writer.begin("GETCONF").text("Type", "Robot").end();
  writer.begin("GETGEO").text("Type", "Robot").end();
  writer.begin("GETCONF").text("Type", "Encoder").end();
}

void WorldHandshake::fail(std::string why) {
  result_ = Result::failed;
  failure_ = std::move(why);
}

}  // namespace kenaf::relayd
