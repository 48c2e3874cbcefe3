// Driving a robot by hand: an operator takes a robot over from its client, or places one of his own.
//
// 1. At most one operator holds a robot. Taking it stops it; from then on only its holder's commands count. Its client
//    gets answers and sensors as before and no notice, but its commands to tracks, flippers and cameras are ignored.
// 2. The holder's command is in force for kOperatorSilence_s of wall-clock time. Then the robot stops until the next.
// 3. Releasing the robot stops it. Its client regains it with its next command; earlier ones are not revived.
// 4. A robot placed by an operator belongs to no client. Once released, it stands where it is until somebody takes it.
//
// Stopped means: tracks at speed 0, flippers braked where they are.
//
// Thread safety: none; for the thread that owns the Simulation. A returned reason says why a request was refused;
// empty: done.
#pragma once

#include <optional>
#include <string_view>

#include "server/world_server/simulation.hpp"

namespace kenaf::world_server {

// A browser repeats its command ten times in this time. A robot drives 0.25 m in it at 0.5 m/s.
inline constexpr double kOperatorSilence_s = 0.5;
inline constexpr std::size_t kMostPlacedRobots = 8;

robot::Command standing_command();

// Takes the robot of that session. Its present holder may take it again.
std::string_view take_robot(Simulation& simulation, std::uint32_t session, OperatorId who);
// The robot that place_robot_by_hand() places; nullptr: its description is missing.
const physics::RobotDescription* robot_to_place(Simulation& simulation);
// A place on the ground, in W, and the direction to look to.
struct GroundPlace {
  Eigen::Vector3d p_W;
  double yaw_rad;
};
// Places a robot of the class USARBot.Kenaf level over `where`, where no robot may stand, lifted until it is free of
// the ground, or else at a free start pose; held by `who`. `session`: its session, if done. `where` must be finite and
// within 100 km of W's origin.
std::string_view place_robot_by_hand(Simulation& simulation, OperatorId who, std::uint32_t& session,
                                     const std::optional<GroundPlace>& where = std::nullopt);
// `command` is limited to the robot's abilities. Numbers must be finite.
std::string_view drive_by_hand(Simulation& simulation, std::uint32_t session, OperatorId who,
                               const robot::Command& command);
// Target direction of a camera; empty members are kept. Positive pan to the left, positive tilt down. Numbers must be
// finite.
struct CameraOrder {
  std::optional<double> pan_rad, tilt_rad, field_of_view_rad;
};
// Limited to the camera's abilities; its mount moves at its own speed, and continues if the holder falls silent.
std::string_view look_by_hand(Simulation& simulation, std::uint32_t session, OperatorId who, std::string_view camera,
                              const CameraOrder& order);
std::string_view let_go(Simulation& simulation, std::uint32_t session, OperatorId who);
// Removes a robot that an operator placed. Allowed to its holder, or to anybody if nobody holds it.
std::string_view remove_placed_robot(Simulation& simulation, std::uint32_t session, OperatorId who);
// Called when the operator is gone.
void let_go_of_all(Simulation& simulation, OperatorId who);

// Applies rule 2, at the time simulation.wall_s.
void watch_operator(Simulation& simulation, Session& session);

}  // namespace kenaf::world_server
