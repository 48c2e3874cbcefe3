// The datagrams between the operator's console and the control process on the robot's PC: their contents as plain
// structs, and the two pure functions that turn them into bytes and back. docs/operator.md has the layout for people.
//
// Loss costs nothing but latency: a Wish is complete and absolute and goes out at a fixed rate, so the next one mends
// the loss of one, and an older one that comes late is dropped. What must happen once only (a new posture of the
// flippers) is numbered and repeated in every Wish.
//
// Units and frames are those of hrt.h, which the control process calls: millimetres, degrees, seconds, amperes, volts;
// x forward, y left, z up; pitch positive nose down; a flipper is 0 straight out and positive with its tip up.
//
// There is no authentication: whoever reaches the control process' port can drive the robot. It belongs on a network of
// its own.
//
// Thread safety: values and pure functions. Nothing allocates.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <variant>

namespace kenaf::teleop {

inline constexpr std::uint32_t kMagic = 0x50'4f'4e'4b;  // the bytes "KNOP" on the wire
inline constexpr std::uint8_t kVersion = 1;
inline constexpr std::size_t kMaxDatagramBytes = 1024;  // one frame of every network, never in fragments
inline constexpr std::size_t kMaxTextBytes = 160;

inline constexpr double kMaxTrack_mmps = 2000;  // as hrt_set_tracks
inline constexpr double kMaxFlipper_deg = 360;  // as hrt_set_flippers
inline constexpr double kMaxMeasured = 1e9;     // of everything in a Status, whatever its unit

// The order of every array of tracks and flippers; that of hrt.h.
enum Track : std::size_t { kLeft, kRight, kTrackCount };
enum Flipper : std::size_t { kFrontLeft, kFrontRight, kRearLeft, kRearRight, kFlipperCount };

// One line for people: printable ASCII, so that it cannot steer the terminal that shows it.
struct Text {
  std::array<char, kMaxTextBytes> characters{};  // zero padded
  std::size_t length = 0;
};
Text text_of(std::string_view words);  // cut to what fits; what is not printable becomes '?'
inline std::string_view view(const Text& text) {
  return {text.characters.data(), text.length};
}

// Console to control, every 50 ms: what the operator wants now.
struct Wish {
  std::uint64_t session;                          // chosen at random by the console when it starts, never 0
  std::uint32_t sequence;                         // 1, 2, 3 ...: only the highest counts (20 a second last for 6 years)
  std::uint32_t newest_status;                    // sequence of the newest Status seen, 0 = none
  bool deadman;                                   // the operator holds the dead-man: without it the tracks stand
  bool emergency_stop;                            // the emergency stop is pressed; latches in the control process
  bool release_emergency;                         // the operator asks for that latch to be released
  std::array<double, kTrackCount> track_mmps;     // within +-kMaxTrack_mmps
  std::uint32_t flipper_order;                    // 0 = none yet, one more each time the operator wants other angles
  std::array<double, kFlipperCount> flipper_deg;  // of that order, all four; within +-kMaxFlipper_deg
};

// What the control process does with the robot.
enum class Mode : std::uint8_t {
  no_robot = 1,        // it is being opened; the message says what went wrong last
  emergency_stop = 2,  // latched until released
  halted = 3,          // stands until the dead-man is seen released; `halt` says why
  ready = 4,           // stands because the dead-man is not held; flippers obey
  driving = 5,
};
std::string_view name_of(Mode mode);

enum class Halt : std::uint8_t {
  start = 1,       // a console has just begun
  silence = 2,     // nothing came from the console for too long
  robot_lost = 3,  // the robot's link broke and was opened anew
  emergency = 4,   // the emergency stop was released
  late = 5,        // what the operator saw when he wished it was too old
};
std::string_view name_of(Halt halt);

// What a Status holds that was measured: the bits of hrt_state.valid.
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
  kPaused = 1u << 1,            // somebody has stopped the simulation's clock
  kStoppedBySilence = 1u << 2,  // the robot stopped the tracks because the control process was too late
  kRecording = 1u << 3,
  kDegraded = 1u << 4,  // the robot goes on without something: `warning` says what
};

// Control to console, every 50 ms while that console has the robot.
struct Status {
  std::uint64_t session;          // of the console it is for
  std::uint32_t sequence;         // 1, 2, 3 ... since the control process was started, for whichever console
  std::uint32_t newest_wish;      // sequence of the newest Wish seen
  double wish_age_s;              // how long ago that one came: what is left of the echo is the network's round trip
  std::uint32_t wishes_received;  // of this session, old ones too: those missing of `newest_wish` were lost
  Mode mode;
  Halt halt;             // why it is or was halted last
  std::uint32_t fields;  // MeasuredField; values whose bit is missing are 0 and mean nothing
  std::uint32_t flags;   // StatusFlag
  double robot_time_s;
  std::array<double, 3> posture_deg;           // roll, pitch, yaw
  std::array<double, kTrackCount> track_mmps;  // measured
  std::array<double, kTrackCount> commanded_track_mmps;
  std::array<double, kTrackCount> track_a;
  std::array<double, kFlipperCount> flipper_deg;  // measured
  std::uint8_t flippers_commanded;                // bit i: flipper i was ever told an angle
  std::array<double, kFlipperCount> commanded_flipper_deg;
  std::array<double, kFlipperCount> flipper_a;
  std::uint32_t flipper_order;  // the newest order that was carried out
  double battery_v;
  std::array<double, 3> odometry;  // x, y in mm, yaw in degrees
  std::array<double, 3> pose_mm;   // true place, where it is known
  double robot_round_trip_ms;      // between control process and robot
  std::uint32_t late_cycles;
  Text message;  // what the control process said last
  Text warning;  // what the robot goes on without
};

// Control to a console that does not have the robot.
struct Taken {
  std::uint64_t session;
  Text by;  // whom it belongs to and for how long that one was silent
};

// Console to control: the operator leaves. The tracks stand at once and the next console is welcome. Sent three times.
struct Bye {
  std::uint64_t session;
};

using Datagram = std::variant<Wish, Status, Taken, Bye>;

enum class DecodeError : std::uint8_t {
  none = 0,
  too_short,  // shorter than the header, or than its kind needs
  too_long,   // bytes left over after the last field
  bad_magic,
  bad_version,
  bad_kind,
  bad_session,   // session 0
  not_finite,    // a number is NaN or infinite
  out_of_range,  // a number beyond the limits above, or a sequence of 0
  bad_value,     // a flag, an enumeration or a text that is none
};

// One sentence for a log line, such as "not an operator's datagram (bad magic)".
std::string_view describe(DecodeError error);

// Writes `datagram` into `out` (at least kMaxDatagramBytes) and returns the bytes used. A number beyond its limit
// is written as the limit, one that is NaN as 0: what is sent can be read.
std::size_t encode(const Datagram& datagram, std::span<std::byte> out);

// Reads one datagram. On an error `out` is unchanged.
DecodeError decode(std::span<const std::byte> bytes, Datagram& out);

}  // namespace kenaf::teleop
