// Writes the relay's messages to the world server: commands in USARSim's units and frames, and session settings. Each
// function appends whole lines to `out`, which keeps its capacity. Thread safety: pure functions.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "formats/protocol/relay_datagram.hpp"

namespace kenaf::relayd {

// Settings requested from the world server. The defaults are for a relay without a commander: an occasional sign of
// life.
struct WorldSession {
  double period_s = 1;
  bool lockstep = false;
  double command_timeout_s = 0.5;
};

// MULTIDRIVE with the flippers that are commanded, then DRIVE, which ends the answer. Surface speeds become spins of a
// wheel of `wheel_radius_m`, flipper angles USARSim joint angles. Without `world_frame` it takes effect at once.
void write_command(std::string& out, const protocol::relay::Command& command, double wheel_radius_m,
                   std::optional<std::int64_t> world_frame);

void write_stop(std::string& out);  // both tracks 0, at once

// `owner`: see RobotPlacement; empty: not written.
void write_world_session(std::string& out, const WorldSession& session, std::string_view owner = {});

void write_ping(std::string& out, std::int64_t id);

// Returns which value is out of range for any Kenaf, or nullptr: more than 10 m/s, more than 100 rad.
const char* out_of_range(const protocol::relay::Command& command);
// The same for a Hello, by the ranges of docs/relay-protocol.md.
const char* out_of_range(const protocol::relay::Hello& hello);

}  // namespace kenaf::relayd
