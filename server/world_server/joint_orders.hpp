// USARSim's orders to a flipper joint, from DRIVE {Name n} {Order i} {Value v} and SET {Type Joint}.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "physics/world.hpp"

namespace kenaf::world_server {

// The numbers are the protocol's (UT2004 KRobot).
enum class JointOrder {
  angle = 0,
  speed = 1,
  torque = 2,
  brake = 3,
  relative_angle = 10,
  relative_speed = 11,
  relative_torque = 12
};

// "Angle", "RelVelocity", "10", ...; UDK's "Target" is an angle.
std::optional<JointOrder> parse_joint_order(std::string_view text);

// The joint order in STA of UT2004, and of {Name AllJoints} {Params a,b,c,d}.
inline constexpr std::array kUsarsimJoints = {robot::kFrontRight, robot::kFrontLeft, robot::kRearRight,
                                              robot::kRearLeft};

// "FRFlipper" and so on, without case; nullopt: no flipper of this robot has that name.
std::optional<robot::Flipper> find_flipper(const physics::RobotDescription& robot, std::string_view name);

// Returns the joint command for `value` (USARSim's sign), limited to the robot's abilities; relative orders start from
// `truth`. An angle is passed on as it is, for the joint turns to it as a direction (robot::reachable_angle); a
// relative one is limited to the joint's range.
robot::JointCommand joint_command(const physics::RobotDescription& description, const physics::RobotTruth& truth,
                                  robot::Flipper flipper, JointOrder order, double value);

}  // namespace kenaf::world_server
