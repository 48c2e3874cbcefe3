#include "formats/protocol/relay_datagram.hpp"

#include <cmath>

namespace kenaf::protocol::relay {

namespace {

constexpr std::uint8_t kFlipperMaskBits = (1u << robot::kFlipperCount) - 1;
constexpr std::uint32_t kEveryField = (robot::kHasGroundTruth << 1) - 1;
constexpr std::uint32_t kStateFieldBits = kEveryField | robot::held(kEveryField);

// Events: bits on the wire.
constexpr std::uint32_t kWorldServerLost = 1u << 0, kStoppedBySilence = 1u << 1, kWorldPaused = 1u << 2,
                        kNotAtStart = 1u << 3;
constexpr std::uint32_t kNoFlipper = 1u << 4;  // the first of four: one for each flipper
constexpr std::uint32_t kStateEventBits = kWorldServerLost | kStoppedBySilence | kWorldPaused | kNotAtStart;

// Each overload lists the fields of one kind in their order on the wire.
void walk(auto& io, Hello& m) {
  io.number(m.period_s);
  io.number(m.command_timeout_s);
  io.flag(m.lockstep);
  io.flag(m.reset_robot);
}

void walk(auto& io, Welcome& m) {
  io.number(m.robot_time_s);
  io.number(m.period_s);
  io.flag(m.lockstep);
}

void walk(auto& io, Refused& m) {
  io.choice(m.reason, RefusedReason::bad_request);
  io.text_and_length(m.text, m.text_length);
}

void walk(auto& io, Command& m) {
  io.integer(m.sequence);
  io.integer(m.frame);
  io.numbers(m.robot.track_speed_mps);

  // A mask names the flippers with an angle; the others are to be kept.
  std::uint8_t with_angle = 0;
  for (std::size_t i = 0; i < robot::kFlipperCount; ++i)
    with_angle |= static_cast<std::uint8_t>((m.robot.flipper[i].mode == robot::JointMode::angle ? 1u : 0u) << i);
  io.bits(with_angle, kFlipperMaskBits);
  for (std::size_t i = 0; i < robot::kFlipperCount; ++i) {
    m.robot.flipper[i].mode = (with_angle >> i & 1u) != 0 ? robot::JointMode::angle : robot::JointMode::keep;
    io.number(m.robot.flipper[i].value);
  }
}

void walk(auto& io, State& m) {
  io.integer(m.robot.frame);
  io.integer(m.acknowledged);
  io.integer(m.robot.late_commands);
  io.bits(m.robot.fields, kStateFieldBits);
  std::uint32_t events = (m.world_server_lost ? kWorldServerLost : 0) |
                         (m.robot.stopped_by_silence ? kStoppedBySilence : 0) | (m.world_paused ? kWorldPaused : 0) |
                         (m.not_at_start ? kNotAtStart : 0);
  // A flipper that a robot with flippers has not is a bit, and its angle 0: robot::kNoFlipper is no number of a
  // datagram.
  const bool has_flippers = (m.robot.fields & robot::kHasFlippers) != 0;
  std::array<double, robot::kFlipperCount> flipper_rad = m.robot.flipper_rad;
  for (std::size_t i = 0; i < robot::kFlipperCount; ++i) {
    if (!std::isnan(flipper_rad[i])) continue;
    flipper_rad[i] = 0;
    if (has_flippers) events |= kNoFlipper << i;
  }
  io.bits(events, kStateEventBits | (has_flippers ? kFlipperMaskBits * kNoFlipper : 0));
  m.world_server_lost = (events & kWorldServerLost) != 0;
  m.robot.stopped_by_silence = (events & kStoppedBySilence) != 0;
  m.world_paused = (events & kWorldPaused) != 0;
  m.not_at_start = (events & kNotAtStart) != 0;
  io.number(m.robot.robot_time_s);
  io.numbers(m.robot.posture_rad);
  io.numbers(m.robot.gyro_radps);
  io.numbers(m.robot.acceleration_mps2);
  io.numbers(m.robot.track_m);
  io.numbers(m.robot.track_mps);
  io.numbers(m.robot.track_a);
  io.numbers(flipper_rad);
  for (std::size_t i = 0; i < robot::kFlipperCount; ++i) {
    const bool has = (events & kNoFlipper << i) == 0;
    io.check(has || (flipper_rad[i] == 0 && !std::signbit(flipper_rad[i])));
    m.robot.flipper_rad[i] = has ? flipper_rad[i] : robot::kNoFlipper;
  }
  io.numbers(m.robot.flipper_a);
  io.number(m.robot.battery_v);
  io.numbers(m.robot.p_WB_m);
  io.numbers(m.robot.orientation_rad);
}

void walk(auto&, Bye&) {}
void walk(auto& io, Ping& m) {
  io.integer(m.id);
}
void walk(auto& io, Pong& m) {
  io.integer(m.id);
}

constexpr DatagramProtocol kProtocol{kMagic, kVersion};
constexpr auto kWalk = [](auto& io, auto& message) { walk(io, message); };

}  // namespace

std::size_t encode(const Datagram& datagram, std::span<std::byte> out) {
  return encode_datagram(kProtocol, datagram, out, kWalk);
}

DecodeError decode(std::span<const std::byte> bytes, Datagram& out) {
  return decode_datagram(kProtocol, bytes, out, kWalk);
}

}  // namespace kenaf::protocol::relay
