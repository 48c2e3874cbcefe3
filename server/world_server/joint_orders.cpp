#include "server/world_server/joint_orders.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "formats/protocol/frames.hpp"
#include "formats/protocol/usarsim_message.hpp"

namespace kenaf::world_server {

std::optional<JointOrder> parse_joint_order(std::string_view text) {
  constexpr std::array<std::pair<std::string_view, JointOrder>, 16> kWords{{
      {"Angle", JointOrder::angle},
      {"Target", JointOrder::angle},
      {"Velocity", JointOrder::speed},
      {"Torque", JointOrder::torque},
      {"Brake", JointOrder::brake},
      {"RelAngle", JointOrder::relative_angle},
      {"RelVelocity", JointOrder::relative_speed},
      {"RelTorque", JointOrder::relative_torque},
      {"Speed", JointOrder::speed},
      {"0", JointOrder::angle},
      {"1", JointOrder::speed},
      {"2", JointOrder::torque},
      {"3", JointOrder::brake},
      {"10", JointOrder::relative_angle},
      {"11", JointOrder::relative_speed},
      {"12", JointOrder::relative_torque},
  }};
  const auto found = std::ranges::find_if(
      kWords, [text](const auto& word) { return protocol::usarsim::equal_ignoring_case(text, word.first); });
  if (found == kWords.end()) return std::nullopt;
  return found->second;
}

std::optional<robot::Flipper> find_flipper(const physics::RobotDescription& robot, std::string_view name) {
  for (std::size_t i = 0; i < robot::kFlipperCount; ++i) {
    const auto flipper = static_cast<robot::Flipper>(i);
    if (robot.has(flipper) &&
        protocol::usarsim::equal_ignoring_case(name, protocol::frames::usarsim_flipper_name(flipper)))
      return flipper;
  }
  return std::nullopt;
}

robot::JointCommand joint_command(const physics::RobotDescription& description, const physics::RobotTruth& truth,
                                  robot::Flipper flipper, JointOrder order, double value) {
  // flipper.front() describes all flippers. The value is converted to positive tip up.
  const physics::FlipperDescription& joint = description.flipper.front();
  const physics::FlipperServoDescription& servo = description.servo;
  const double tip_up = protocol::frames::tip_up_from_usarsim_flipper(flipper, value);

  // Commands are clamped to what the servo can do. An angle is a direction: the joint turns to it within its range.
  const auto angle = [&](double rad) { return robot::JointCommand{robot::JointMode::angle, rad}; };
  const auto speed = [&](double radps) {
    return robot::JointCommand{robot::JointMode::speed,
                               std::clamp(radps, -servo.max_speed_radps, servo.max_speed_radps)};
  };
  const auto torque = [&](double nm) {
    return robot::JointCommand{robot::JointMode::torque, std::clamp(nm, -servo.max_torque_nm, servo.max_torque_nm)};
  };

  // Relative orders start from the present true state, not from the previous command.
  switch (order) {
    case JointOrder::angle:
      return angle(tip_up);
    case JointOrder::speed:
      return speed(tip_up);
    case JointOrder::torque:
      return torque(tip_up);
    case JointOrder::relative_angle:
      // it says which way round, and so ends at the end of the range
      return angle(std::clamp(truth.flipper_rad[flipper] + tip_up, joint.min_angle_rad, joint.max_angle_rad));
    case JointOrder::relative_speed:
      return speed(truth.flipper_radps[flipper] + tip_up);
    case JointOrder::relative_torque:
      return torque(truth.flipper_nm[flipper] + tip_up);
    case JointOrder::brake:
      break;
  }
  return {robot::JointMode::brake, 0};
}

}  // namespace kenaf::world_server
