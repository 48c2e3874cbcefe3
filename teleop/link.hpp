// The datagrams between the operator's console and the control process on the robot's PC: their contents as plain
// structs, and two pure functions that encode and decode them (formats/protocol/datagram_codec.hpp).
//
// On the wire: little-endian, numbers as IEEE 754 doubles, no padding. Header, 16 bytes: u32 the bytes "KNOP", u8
// version, u8 kind (1 Wish, 2 Status, 3 Taken, 4 Bye), u16 length of the whole datagram, u64 session. Then the fields
// in the order of the structs; a bool or an enumeration is a u8, a Text a u8 length and its 160 characters. A Wish has
// 79 bytes, a Status 617, a Taken 177, a Bye 16. A datagram that is cut, too long, of another version or out of range
// is ignored, with a log line at most once a second. So is a Wish that is not newer than the newest; it is no sign of
// life. Of Statuses only one with the highest sequence counts, or a lower one that echoes a newer wish (the control
// restarted).
//
// Loss costs only latency: a Wish is complete and absolute and is sent at a fixed rate, so the next one compensates for
// a lost one, and an older one that arrives late is dropped. Actions that must happen only once (a new flipper posture)
// are numbered and repeated in every Wish.
//
// Units and frames are those of hrt.h, which the control process calls: millimetres, degrees, seconds, amperes, volts;
// x forward, y left, z up; pitch positive nose down; a flipper is 0 straight out and positive with its tip up.
//
// There is no authentication: anyone who reaches the control process' port can drive the robot. Use a separate network.
//
// Thread safety: values and pure functions. Nothing allocates.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <variant>

#include "formats/protocol/datagram_codec.hpp"

namespace kenaf::teleop {

inline constexpr std::uint32_t kMagic = 0x50'4f'4e'4b;  // the bytes "KNOP" on the wire
inline constexpr std::uint8_t kVersion = 1;
inline constexpr std::size_t kMaxDatagramBytes = 1024;  // fits one frame of every network, without fragmentation
inline constexpr std::size_t kMaxTextBytes = 160;

inline constexpr double kMaxTrack_mmps = 2000;  // as hrt_set_tracks
inline constexpr double kMaxFlipper_deg = 360;  // as hrt_set_flippers
inline constexpr double kMaxMeasured = 1e9;     // limit of every number in a Status, in its unit

// The order of every array of tracks and flippers; that of hrt.h.
enum Track : std::size_t { kLeft, kRight, kTrackCount };
enum Flipper : std::size_t { kFrontLeft, kFrontRight, kRearLeft, kRearRight, kFlipperCount };

// One line of text: printable ASCII, so that it cannot control the terminal that shows it.
struct Text {
  std::array<char, kMaxTextBytes> characters{};  // zero padded
  std::size_t length = 0;
};
Text text_of(std::string_view words);  // truncated to fit; non-printable characters become '?'
inline std::string_view view(const Text& text) {
  return {text.characters.data(), text.length};
}

// Console to control, every 50 ms: the operator's present wish.
struct Wish {
  std::uint64_t session;        // random, chosen by the console at its start, never 0
  std::uint32_t sequence;       // 1, 2, 3 ...: only the highest counts (at 20 a second enough for 6 years)
  std::uint32_t newest_status;  // sequence of the newest Status seen, 0 = none
  bool deadman;                 // the operator holds the dead-man; otherwise the tracks stop
  bool emergency_stop;          // the emergency stop is pressed; latches in the control process
  bool release_emergency;       // the operator requests the release of that latch
  std::array<double, kTrackCount> track_mmps;     // within +-kMaxTrack_mmps
  std::uint32_t flipper_order;                    // 0 = none yet, incremented whenever the operator wants other angles
  std::array<double, kFlipperCount> flipper_deg;  // of that order, all four; within +-kMaxFlipper_deg
};

// State of the control process.
enum class Mode : std::uint8_t {
  no_robot = 1,        // it is being opened; the message gives the last error
  emergency_stop = 2,  // latched until released
  halted = 3,          // stopped until the dead-man is seen released; `halt` gives the reason
  ready = 4,           // stopped because the dead-man is not held; flippers obey
  driving = 5,
};
std::string_view name_of(Mode mode);

enum class Halt : std::uint8_t {
  start = 1,       // a console has just started
  silence = 2,     // nothing came from the console for too long
  robot_lost = 3,  // the robot's link broke and was reopened
  emergency = 4,   // the emergency stop was released
  late = 5,        // the operator's view was too old when he made his wish
};
std::string_view name_of(Halt halt);

// Measured fields of a Status: the bits of hrt_state.valid.
enum MeasuredField : std::uint32_t {
  kHasPosture = 1u << 0,
  kHasEncoders = 1u << 1,
  kHasFlippers = 1u << 2,
  kHasCurrents = 1u << 3,
  kHasBattery = 1u << 4,
  kHasInertial = 1u << 5,
  kHasPose = 1u << 6,
};

enum StatusFlag : std::uint32_t {
  kSimulated = 1u << 0,
  kPaused = 1u << 1,            // the simulation's clock has been stopped by somebody
  kStoppedBySilence = 1u << 2,  // the robot stopped the tracks because the control process was too late
  kRecording = 1u << 3,
  kDegraded = 1u << 4,  // something of the robot is missing: `warning` says what
};

// Control to console, every 50 ms while that console has the robot.
struct Status {
  std::uint64_t session;          // of the console it is for
  std::uint32_t sequence;         // 1, 2, 3 ... since the start of the control process, over all consoles
  std::uint32_t newest_wish;      // sequence of the newest Wish seen
  double wish_age_s;              // age of that one: the echo time minus this is the network's round trip
  std::uint32_t wishes_received;  // in this session, including late ones; the difference to `newest_wish` was lost
  Mode mode;
  Halt halt;             // reason for the present or last halt
  std::uint32_t fields;  // MeasuredField; values without their bit are 0 and have no meaning
  std::uint32_t flags;   // StatusFlag
  double robot_time_s;
  std::array<double, 3> posture_deg;           // roll, pitch, yaw
  std::array<double, kTrackCount> track_mmps;  // measured
  std::array<double, kTrackCount> commanded_track_mmps;
  std::array<double, kTrackCount> track_a;
  std::array<double, kFlipperCount> flipper_deg;  // measured
  std::uint8_t flippers_commanded;                // bit i: the robot has flipper i, and it was ever commanded
  std::array<double, kFlipperCount> commanded_flipper_deg;
  std::array<double, kFlipperCount> flipper_a;
  std::uint32_t flipper_order;  // the newest order carried out
  double battery_v;
  std::array<double, 3> odometry;  // x, y in mm, yaw in degrees
  std::array<double, 3> pose_mm;   // true position, if known
  double robot_round_trip_ms;      // between control process and robot
  std::uint32_t late_cycles;
  Text message;  // the last message of the control process
  Text warning;  // what is missing on the robot
};

// Control to a console that does not have the robot.
struct Taken {
  std::uint64_t session;
  Text by;  // the console that has the robot, and how long it has been silent
};

// Console to control: the operator leaves. The tracks stop at once and the seat is free. Sent three times.
struct Bye {
  std::uint64_t session;
};

using Datagram = std::variant<Wish, Status, Taken, Bye>;

// Writes `datagram` into `out` (at least kMaxDatagramBytes) and returns the bytes used. A number beyond its limit is
// written as the limit, NaN as 0, so that every datagram sent can be decoded.
std::size_t encode(const Datagram& datagram, std::span<std::byte> out);

// Reads one datagram. On an error `out` is unchanged.
protocol::DecodeError decode(std::span<const std::byte> bytes, Datagram& out);

}  // namespace kenaf::teleop
