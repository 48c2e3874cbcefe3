#include "relayd/world_handshake.hpp"

#include <fmt/format.h>

#include "protocol/frames.hpp"

namespace kenaf::relayd {

namespace {

using namespace std::chrono_literals;
constexpr usarsim::NumberFormat kExact{12, false};
constexpr auto kGreetingWithin = 1s;
constexpr auto kStartPosesWithin = 500ms;
constexpr auto kRobotWithin = 3s;
constexpr auto kAnswerAfterRobotWithin = 500ms;

bool has_value(const usarsim::MessageView& message, std::string_view key, std::string_view value) {
  const auto found = message.find(key);
  return found && usarsim::equal_ignoring_case(*found, value);
}

// `NFO {StartPoses 2} {PlayerStart_0 x,y,z r,p,y ...}` or `NFO {StartPoses 1} {Name PlayerStart_0 Location ...}`.
// Empty: the world has none.
std::string first_start_pose(const usarsim::MessageView& message) {
  for (const usarsim::Group& group : message.all()) {
    if (usarsim::equal_ignoring_case(group.key, "StartPoses")) continue;
    if (!usarsim::equal_ignoring_case(group.key, "Name")) return std::string(group.key);
    std::string_view rest = group.value;
    return std::string(usarsim::next_word(rest));
  }
  return {};
}

}  // namespace

std::optional<SessionAnswer> read_session_answer(const usarsim::MessageView& message) {
  if (!message.is("RES") || !has_value(message, "Type", "Control") || !has_value(message, "Name", "Session")) {
    return std::nullopt;
  }
  SessionAnswer answer;
  if (!has_value(message, "Status", "OK")) {
    answer.refusal = message.find("Reason").value_or("no reason given");
    return answer;
  }
  const auto number = [&](std::string_view key, double otherwise) {
    const auto text = message.find(key);
    return text ? usarsim::parse_number(*text).value_or(otherwise) : otherwise;
  };
  answer.ready.robot_time_s = number("Time", 0);
  answer.ready.period_s = number("Period", answer.ready.period_s);
  const auto lockstep = message.find("Lockstep");
  answer.ready.lockstep = lockstep && usarsim::parse_bool(*lockstep).value_or(false);
  return answer;
}

WorldHandshake::WorldHandshake(const RobotPlacement& placement, const WorldSession& session, TimePoint connected)
    : placement_(placement), session_(session), deadline_(connected + kGreetingWithin) {}

void WorldHandshake::on_message(const usarsim::MessageView& message, TimePoint now, std::string& out) {
  if (step_ == Step::greeting) {
    if (message.is("NFO")) after_greeting(now, out);
  } else if (step_ == Step::choosing_start) {
    if (message.is("NFO") && message.find("StartPoses")) place(first_start_pose(message), now, out);
  } else if (const auto answer = read_session_answer(message)) {
    if (!answer->refusal.empty()) return fail("it refused the session: " + answer->refusal);
    accepted_ = true;
    ready_ = answer->ready;
  } else if (message.is("STA")) {
    if (!has_robot_) deadline_ = now + kAnswerAfterRobotWithin;
    has_robot_ = true;
  }
  if (accepted_ && has_robot_ && result_ == Result::pending) result_ = Result::extended;
}

void WorldHandshake::on_time(TimePoint now, std::string& out) {
  if (result_ != Result::pending || now < deadline_) return;
  if (step_ == Step::greeting) {
    after_greeting(now, out);
  } else if (step_ == Step::choosing_start) {
    place({}, now, out);
  } else if (has_robot_) {
    result_ = Result::plain;
  } else {
    fail(fmt::format("it placed no robot of class '{}' (no STA within {} s of INIT); see its log",
                     placement_.class_name, kRobotWithin.count()));
  }
}

void WorldHandshake::after_greeting(TimePoint now, std::string& out) {
  if (placement_.pose || !placement_.start.empty()) return place(placement_.start, now, out);
  step_ = Step::choosing_start;
  deadline_ = now + kStartPosesWithin;
  usarsim::MessageWriter(out).begin("GETSTARTPOSES").end();
}

void WorldHandshake::place(const std::string& start, TimePoint now, std::string& out) {
  step_ = Step::placing;
  deadline_ = now + kRobotWithin;
  usarsim::MessageWriter writer(out);
  writer.begin("INIT").text("ClassName", placement_.class_name).text("Name", placement_.name);
  if (placement_.pose || start.empty()) {
    const auto pose = placement_.pose.value_or(std::array<double, 6>{});
    writer.numbers("Location", frames::usarsim_vector_from_rep103({pose[0], pose[1], pose[2]}), kExact);
    writer.numbers("Rotation", frames::usarsim_angles_from_rep103({pose[3], pose[4], pose[5]}), kExact);
  } else {
    writer.text("Start", start);
  }
  writer.end();
  writer.begin("GETCONF").text("Type", "Robot").end();
  writer.begin("GETGEO").text("Type", "Robot").end();
  writer.begin("GETCONF").text("Type", "Encoder").end();
  write_world_session(out, session_);
}

void WorldHandshake::fail(std::string why) {
  result_ = Result::failed;
  failure_ = std::move(why);
}

}  // namespace kenaf::relayd
