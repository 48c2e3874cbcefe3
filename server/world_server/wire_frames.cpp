#include "server/world_server/wire_frames.hpp"

#include <cmath>
#include <numbers>

namespace kenaf::world_server {

namespace {

std::optional<protocol::frames::Vector3> read_three(const protocol::usarsim::MessageView& message,
                                                    std::string_view key) {
  const auto text = message.find(key);
  protocol::frames::Vector3 v;
  if (!text || !protocol::usarsim::parse_numbers(*text, v)) return std::nullopt;
  for (const double value : v) {
    if (std::abs(value) > kFarthest) return std::nullopt;
  }
  return v;
}

}  // namespace

protocol::frames::Vector3 wire_positive_angles(const Eigen::Vector3d& roll_pitch_yaw) {
  protocol::frames::Vector3 angles = wire_angles(roll_pitch_yaw);
  for (double& angle : angles) {
    if (angle < 0) angle += 2 * std::numbers::pi;
  }
  return angles;
}

std::optional<Eigen::Vector3d> read_location(const protocol::usarsim::MessageView& message, std::string_view key) {
  const auto v = read_three(message, key);
  if (!v) return std::nullopt;
  return vector_from(protocol::frames::rep103_vector_from_usarsim(*v));
}

std::optional<Eigen::Quaterniond> read_rotation(const protocol::usarsim::MessageView& message, std::string_view key) {
  const auto v = read_three(message, key);
  if (!v) return std::nullopt;
  return physics::rotation_from(vector_from(protocol::frames::rep103_angles_from_usarsim(*v)));
}

}  // namespace kenaf::world_server
