#include "link.hpp"

#include <algorithm>

namespace kenaf::teleop {

namespace {

constexpr std::uint8_t kFlipperBits = (1u << kFlipperCount) - 1;
constexpr std::uint32_t kMeasuredBits = (kHasPose << 1) - 1;
constexpr std::uint32_t kFlagBits = (kDegraded << 1) - 1;

bool is_printable(char character) {
  return character >= ' ' && character <= '~';
}

void walk(auto& io, Text& text) {
  io.length_and_text(text.length, text.characters);
  io.check(std::ranges::all_of(std::span(text.characters).first(std::min(text.length, kMaxTextBytes)), is_printable));
}

// Each overload lists the fields of one kind in their order on the wire.
void walk(auto& io, Wish& m) {
  io.counter(m.sequence);
  io.integer(m.newest_status);
  io.flag(m.deadman);
  io.flag(m.emergency_stop);
  io.flag(m.release_emergency);
  io.numbers(m.track_mmps, kMaxTrack_mmps);
  io.integer(m.flipper_order);
  io.numbers(m.flipper_deg, kMaxFlipper_deg);
}

void walk(auto& io, Status& m) {
  // Numbers of the link, then the decision, then the robot's state in the order of hrt_state, then the texts.
  io.counter(m.sequence);
  io.integer(m.newest_wish);
  io.number(m.wish_age_s, kMaxMeasured);
  io.integer(m.wishes_received);
  io.choice(m.mode, Mode::driving);
  io.choice(m.halt, Halt::late);
  io.bits(m.fields, kMeasuredBits);
  io.bits(m.flags, kFlagBits);
  io.number(m.robot_time_s, kMaxMeasured);
  io.numbers(m.posture_deg, kMaxMeasured);
  io.numbers(m.track_mmps, kMaxMeasured);
  io.numbers(m.commanded_track_mmps, kMaxMeasured);
  io.numbers(m.track_a, kMaxMeasured);
  io.numbers(m.flipper_deg, kMaxMeasured);
  io.bits(m.flippers_commanded, kFlipperBits);
  io.numbers(m.commanded_flipper_deg, kMaxMeasured);
  io.numbers(m.flipper_a, kMaxMeasured);
  io.integer(m.flipper_order);
  io.number(m.battery_v, kMaxMeasured);
  io.numbers(m.odometry, kMaxMeasured);
  io.numbers(m.pose_mm, kMaxMeasured);
  io.number(m.robot_round_trip_ms, kMaxMeasured);
  io.integer(m.late_cycles);
  walk(io, m.message);
  walk(io, m.warning);
}

void walk(auto& io, Taken& m) {
  walk(io, m.by);
}

void walk(auto&, Bye&) {}

constexpr protocol::DatagramProtocol kProtocol{kMagic, kVersion};
constexpr auto kWalk = [](auto& io, auto& message) { walk(io, message); };

}  // namespace

Text text_of(std::string_view words) {
  Text text;
  text.length = std::min(words.size(), kMaxTextBytes);
  std::transform(words.begin(), words.begin() + static_cast<std::ptrdiff_t>(text.length), text.characters.begin(),
                 [](char character) { return is_printable(character) ? character : '?'; });
  return text;
}

std::string_view name_of(Mode mode) {
  switch (mode) {
    case Mode::no_robot:
      return "no_robot";
    case Mode::emergency_stop:
      return "emergency_stop";
    case Mode::halted:
      return "halted";
    case Mode::ready:
      return "ready";
    case Mode::driving:
      return "driving";
  }
  return "unknown";
}

std::string_view name_of(Halt halt) {
  switch (halt) {
    case Halt::start:
      return "start";
    case Halt::silence:
      return "silence";
    case Halt::robot_lost:
      return "robot_lost";
    case Halt::emergency:
      return "emergency";
    case Halt::late:
      return "late";
  }
  return "unknown";
}

std::size_t encode(const Datagram& datagram, std::span<std::byte> out) {
  return protocol::encode_datagram(kProtocol, datagram, out, kWalk);
}

protocol::DecodeError decode(std::span<const std::byte> bytes, Datagram& out) {
  return protocol::decode_datagram(kProtocol, bytes, out, kWalk);
}

}  // namespace kenaf::teleop
