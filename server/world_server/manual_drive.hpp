// Driving a robot by hand: an operator takes a robot over from its client, or places one of his own.
//
// 1. A robot is held by one operator at most. Taking it makes it stand; from then on only its holder's commands count.
// Its
//    client is told nothing new: it is answered, and sent sensors, as before, but what it commands is kept out, of
//    tracks, flippers and cameras alike.
// 2. The holder's word holds for kOperatorSilence_s of wall-clock time. Then the robot stands until he says the next.
// 3. Letting go makes the robot stand. Its client has it back by its next command; an earlier one does not come back to
// life.
// 4. A robot that an operator placed belongs to no client. Let go of, it stands where it is for whoever takes it next.
//
// To stand: tracks at speed 0, flippers braked where they are.
//
// Thread safety: none; on the thread that owns the Simulation. A returned reason says why it was refused; empty: done.
#pragma once

#include <optional>
#include <string_view>

#include "server/world_server/simulation.hpp"

namespace kenaf::world_server {

// A browser repeats its word ten times in that time. A robot drives 0.25 m in it at 0.5 m/s.
inline constexpr double kOperatorSilence_s = 0.5;
inline constexpr std::size_t kMostPlacedRobots = 8;

robot::Command standing_command();

// Takes the robot of that session. Who holds it already may take it again.
std::string_view take_robot(Simulation& simulation, std::uint32_t session, OperatorId who);
// Places a robot of the class USARBot.Kenaf at a free start pose, for `who` to hold; `session`: where it is, if done.
std::string_view place_robot_by_hand(Simulation& simulation, OperatorId who, std::uint32_t& session);
// `command` is limited to what the robot can do. Numbers must be finite.
std::string_view drive_by_hand(Simulation& simulation, std::uint32_t session, OperatorId who,
                               const robot::Command& command);
// Where a camera shall look; what is empty stays. Positive pan to the left, positive tilt down. Numbers must be finite.
struct CameraOrder {
  std::optional<double> pan_rad, tilt_rad, field_of_view_rad;
};
// Limited to what the camera can do; its mount turns there at its own speed, and goes on to when the holder is silent.
std::string_view look_by_hand(Simulation& simulation, std::uint32_t session, OperatorId who, std::string_view camera,
                              const CameraOrder& order);
std::string_view let_go(Simulation& simulation, std::uint32_t session, OperatorId who);
// Takes a robot that an operator placed out of the world. Its holder may, anybody where nobody holds it.
std::string_view remove_placed_robot(Simulation& simulation, std::uint32_t session, OperatorId who);
// The operator is gone.
void let_go_of_all(Simulation& simulation, OperatorId who);

// Rule 2, at the time simulation.wall_s.
void watch_operator(Simulation& simulation, Session& session);

}  // namespace kenaf::world_server
