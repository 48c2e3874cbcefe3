// Converts Eigen and physics values to and from USARSim's z-down frames; the signs are in formats/protocol/frames.hpp.
#pragma once

#include <optional>

#include "formats/protocol/frames.hpp"
#include "formats/protocol/usarsim_message.hpp"
#include "physics/pose.hpp"

namespace kenaf::world_server {

inline protocol::frames::Vector3 array_from(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}
inline Eigen::Vector3d vector_from(const protocol::frames::Vector3& v) {
  return {v[0], v[1], v[2]};
}

inline protocol::frames::Vector3 wire_vector(const Eigen::Vector3d& v) {
  return protocol::frames::usarsim_vector_from_rep103(array_from(v));
}
inline protocol::frames::Vector3 wire_angles(const Eigen::Vector3d& roll_pitch_yaw) {
  return protocol::frames::usarsim_angles_from_rep103(array_from(roll_pitch_yaw));
}
// Each in [0, 2 pi), as in the UT2004 server and UDK's INS.
protocol::frames::Vector3 wire_positive_angles(const Eigen::Vector3d& roll_pitch_yaw);
inline protocol::frames::Vector3 wire_angles(const Eigen::Quaterniond& q) {
  return wire_angles(physics::roll_pitch_yaw(q));
}

// Beyond this distance, in m on an axis, physics would lose its precision.
inline constexpr double kFarthest = 1e5;

// Reads a client's vector or rotation; nullopt if the group is missing, not three numbers, or beyond kFarthest.
std::optional<Eigen::Vector3d> read_location(const protocol::usarsim::MessageView& message, std::string_view key);
std::optional<Eigen::Quaterniond> read_rotation(const protocol::usarsim::MessageView& message, std::string_view key);

}  // namespace kenaf::world_server
