// The datagrams between libkenaf_sim and relayd: their contents as plain structs, and the two pure functions that
// turn them into bytes and back (datagram_codec.hpp). docs/relay-protocol.md describes the protocol.
//
// Frames and units: SI and radians; world W and body B are x forward, y left, z up (REP 103). Angles of a pose are the
// intrinsic z-y-x angles roll, pitch, yaw; pitch is positive nose down. Flippers: robot/parts.hpp.
//
// Thread safety: everything here is a value or a pure function. Nothing allocates.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <variant>

#include "formats/protocol/datagram_codec.hpp"
#include "robot/command.hpp"
#include "robot/parts.hpp"
#include "robot/state.hpp"

namespace kenaf::protocol::relay {

inline constexpr std::uint32_t kMagic = 0x46'41'4e'4b;  // the bytes "KNAF" on the wire
inline constexpr std::uint8_t kVersion = 1;
inline constexpr std::size_t kMaxDatagramBytes = 512;
inline constexpr std::size_t kMaxReasonBytes = 200;

// Asks to become the commander of the robot. Resent until Welcome or Refused arrives.
struct Hello {
  std::uint64_t session;     // chosen at random by the commander, never 0
  double period_s;           // robot time between two States, 0.001 to 1
  double command_timeout_s;  // robot time of silence after which the robot is stopped, 0.01 to 10
  bool lockstep;             // robot time waits for each Command
  bool reset_robot;          // put the robot back to its start pose first
};

struct Welcome {
  std::uint64_t session;
  double robot_time_s;
  double period_s;  // in force: a world server that cannot change its rate keeps its own
  bool lockstep;    // in force
};

enum class RefusedReason : std::uint8_t {
  busy = 1,             // another commander has the robot
  no_world_server = 2,  // the relay has no connection to a world server, or it accepted no robot
  unknown_session = 3,  // the relay does not know this session: it was restarted, or the session had fallen silent
  bad_request = 4,      // a field out of its range
};

struct Refused {
  std::uint64_t session;
  RefusedReason reason;
  std::array<char, kMaxReasonBytes> text;  // UTF-8, zero padded
  std::size_t text_length;
};

// The command from the frame after `frame` on. Complete and absolute: only the newest matters, so a lost or doubled
// Command affects latency only. Resent every few milliseconds until a State acknowledges it.
struct Command {
  std::uint64_t session;
  std::uint32_t sequence;  // starts at 1, one more for each new Command; a resent Command keeps its sequence
  std::uint32_t frame;     // the State this answers; 0 before the first
  robot::Command robot;    // flippers: an angle, or keep
};

// Measurements and the state of the session. stopped_by_silence: no Command came within command_timeout_s.
struct State {
  std::uint64_t session;
  std::uint32_t acknowledged;  // sequence of the newest Command handed to the world server, 0 = none
  bool world_server_lost;      // the connection to the world server broke; the session is over
  bool world_paused;           // another client has stopped robot time
  bool not_at_start;           // the world's first start pose was not free: the robot was placed at another one
  robot::State robot;
};

// Ends the session: the robot stops and the relay is free for the next commander. Not answered; sent three times.
struct Bye {
  std::uint64_t session;
};

// Measures the round trip to the world server and back: the relay forwards it at once and answers with Pong.
struct Ping {
  std::uint64_t session;
  std::uint32_t id;
};

struct Pong {
  std::uint64_t session;
  std::uint32_t id;
};

using Datagram = std::variant<Hello, Welcome, Refused, Command, State, Bye, Ping, Pong>;

// Writes `datagram` into `out` and returns the bytes used; `out` holds at least kMaxDatagramBytes.
std::size_t encode(const Datagram& datagram, std::span<std::byte> out);

// Reads one datagram. On an error `out` is unchanged. Checks form, not ranges: the relay checks whether the robot can
// drive a speed.
DecodeError decode(std::span<const std::byte> bytes, Datagram& out);

}  // namespace kenaf::protocol::relay
