#include "relayd/command_transform.hpp"

#include <algorithm>
#include <cmath>

#include "formats/protocol/frames.hpp"
#include "formats/protocol/usarsim_message.hpp"

namespace kenaf::relayd {

namespace {

constexpr double kMaxTrackSpeed_mps = 10;
constexpr double kMaxFlipperAngle_rad = 100;

}  // namespace

void write_command(std::string& out, const protocol::relay::Command& command, double wheel_radius_m,
                   std::optional<std::int64_t> world_frame) {
  protocol::usarsim::MessageWriter writer(out);
  const auto has_angle = [](const robot::JointCommand& joint) { return joint.mode == robot::JointMode::angle; };
  if (std::ranges::any_of(command.robot.flipper, has_angle)) {
    writer.begin("MULTIDRIVE");
    for (std::size_t i = 0; i < robot::kFlipperCount; ++i) {
      if (!has_angle(command.robot.flipper[i])) continue;
      const auto flipper = static_cast<robot::Flipper>(i);
      writer.number(protocol::frames::usarsim_flipper_name(flipper),
                    protocol::frames::usarsim_flipper_from_tip_up(flipper, command.robot.flipper[i].value),
                    protocol::usarsim::kExactNumber);
    }
    if (world_frame) writer.integer("Frame", *world_frame);
    writer.end();
  }
  const auto spin = [&](robot::Track track) {
    return protocol::frames::spin_from_surface_speed(command.robot.track_speed_mps[track], wheel_radius_m);
  };
  writer.begin("DRIVE")
      .number("Left", spin(robot::kLeft), protocol::usarsim::kExactNumber)
      .number("Right", spin(robot::kRight), protocol::usarsim::kExactNumber);
  if (world_frame) writer.integer("Frame", *world_frame);
  writer.end();
}

void write_stop(std::string& out) {
  protocol::usarsim::MessageWriter(out)
      .begin("DRIVE")
      .number("Left", 0, protocol::usarsim::kExactNumber)
      .number("Right", 0, protocol::usarsim::kExactNumber)
      .end();
}

void write_world_session(std::string& out, const WorldSession& session, std::string_view owner) {
  protocol::usarsim::MessageWriter writer(out);
  writer.begin("CONTROL")
      .text("Type", "Session")
      .number("Period", session.period_s, protocol::usarsim::kExactNumber)
      .boolean("Lockstep", session.lockstep)
      .number("CommandTimeout", session.command_timeout_s, protocol::usarsim::kExactNumber)
      .integer("Precision", 12);
  if (!owner.empty()) writer.text("Owner", owner);
  writer.end();
}

void write_ping(std::string& out, std::int64_t id) {
  protocol::usarsim::MessageWriter(out).begin("PING").integer("Id", id).end();
}

const char* out_of_range(const protocol::relay::Command& command) {
  const auto beyond = [](double limit) { return [limit](double value) { return std::abs(value) > limit; }; };
  if (std::ranges::any_of(command.robot.track_speed_mps, beyond(kMaxTrackSpeed_mps)))
    return "a track speed above 10 m/s";
  if (std::ranges::any_of(command.robot.flipper, beyond(kMaxFlipperAngle_rad), &robot::JointCommand::value))
    return "a flipper angle above 100 rad";
  return nullptr;
}

const char* out_of_range(const protocol::relay::Hello& hello) {
  if (hello.period_s < 0.001 || hello.period_s > 1) return "the period is not from 0.001 to 1 s";
  if (hello.command_timeout_s < 0.01 || hello.command_timeout_s > 10) {
    return "the command timeout is not from 0.01 to 10 s";
  }
  return nullptr;
}

}  // namespace kenaf::relayd
