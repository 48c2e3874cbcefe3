#include "formats/protocol/relay_datagram.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <concepts>
#include <limits>
#include <utility>

namespace kenaf::protocol::relay {

namespace {

static_assert(std::numeric_limits<double>::is_iec559 && sizeof(double) == 8);

// Header: u32 magic, u8 version, u8 kind, u16 length of the whole datagram, u64 session. All little-endian.
constexpr std::size_t kHeaderBytes = 16;
constexpr std::size_t kLengthOffset = 6;

constexpr std::uint8_t kFlipperMaskBits = (1u << robot::kFlipperCount) - 1;
constexpr std::uint32_t kEveryField = (robot::kHasGroundTruth << 1) - 1;
constexpr std::uint32_t kStateFieldBits = kEveryField | robot::held(kEveryField);

// Events: bits on the wire.
constexpr std::uint32_t kWorldServerLost = 1u << 0, kStoppedBySilence = 1u << 1, kWorldPaused = 1u << 2;
constexpr std::uint32_t kStateEventBits = kWorldServerLost | kStoppedBySilence | kWorldPaused;

// Each overload lists the payload of one kind in its order on the wire. The Writer and the Reader walk the same list,
// so they cannot disagree. The session is part of the header.
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
  io.reason(m.reason);
  io.text(m.text, m.text_length);
}

void walk(auto& io, Command& m) {
  io.integer(m.sequence);
  io.integer(m.frame);
  io.numbers(m.track_speed_mps);
  io.bits(m.flipper_mask, kFlipperMaskBits);
  io.numbers(m.flipper_rad);
}

void walk(auto& io, State& m) {
  io.integer(m.robot.frame);
  io.integer(m.acknowledged);
  io.integer(m.robot.late_commands);
  io.bits(m.robot.fields, kStateFieldBits);
  std::uint32_t events = (m.world_server_lost ? kWorldServerLost : 0) |
                         (m.robot.stopped_by_silence ? kStoppedBySilence : 0) | (m.world_paused ? kWorldPaused : 0);
  io.bits(events, kStateEventBits);
  m.world_server_lost = (events & kWorldServerLost) != 0;
  m.robot.stopped_by_silence = (events & kStoppedBySilence) != 0;
  m.world_paused = (events & kWorldPaused) != 0;
  io.number(m.robot.robot_time_s);
  io.numbers(m.robot.posture_rad);
  io.numbers(m.robot.gyro_radps);
  io.numbers(m.robot.acceleration_mps2);
  io.numbers(m.robot.track_m);
  io.numbers(m.robot.track_mps);
  io.numbers(m.robot.track_a);
  io.numbers(m.robot.flipper_rad);
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

class Writer {
 public:
  explicit Writer(std::span<std::byte> out) : out_(out) {}

  void integer(std::unsigned_integral auto value) {
    assert(used_ + sizeof value <= out_.size());
    for (std::size_t i = 0; i < sizeof value; ++i) out_[used_++] = static_cast<std::byte>((value >> (8 * i)) & 0xff);
  }
  void number(double value) { integer(std::bit_cast<std::uint64_t>(value)); }
  template <std::size_t n>
  void numbers(const std::array<double, n>& values) {
    for (const double value : values) number(value);
  }
  void flag(bool value) { integer(std::uint8_t{value}); }
  template <std::unsigned_integral T>
  void bits(T value, T known) {
    integer(static_cast<T>(value & known));
  }
  void reason(RefusedReason value) { integer(static_cast<std::uint8_t>(value)); }
  void text(const std::array<char, kMaxReasonBytes>& characters, std::size_t length) {
    length = std::min(length, characters.size());
    for (std::size_t i = 0; i < characters.size(); ++i) {
      integer(static_cast<std::uint8_t>(i < length ? characters[i] : '\0'));
    }
    integer(static_cast<std::uint8_t>(length));
  }

  std::size_t used() const { return used_; }

 private:
  std::span<std::byte> out_;
  std::size_t used_ = 0;
};

// Keeps the first error. Integers read beyond the end are 0.
class Reader {
 public:
  explicit Reader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  template <std::unsigned_integral T>
  void integer(T& value) {
    value = 0;
    if (bytes_.size() < sizeof value) return fail(DecodeError::too_short);
    for (std::size_t i = 0; i < sizeof value; ++i) {
      value = static_cast<T>(value | static_cast<T>(std::to_integer<T>(bytes_[i]) << (8 * i)));
    }
    bytes_ = bytes_.subspan(sizeof value);
  }
  void number(double& value) {
    std::uint64_t pattern = 0;
    integer(pattern);
    value = std::bit_cast<double>(pattern);
    if (!std::isfinite(value)) fail(DecodeError::not_finite);
  }
  template <std::size_t n>
  void numbers(std::array<double, n>& values) {
    for (double& value : values) number(value);
  }
  void flag(bool& value) {
    std::uint8_t byte = 0;
    integer(byte);
    if (byte > 1) fail(DecodeError::bad_value);
    value = byte == 1;
  }
  template <std::unsigned_integral T>
  void bits(T& value, T known) {
    integer(value);
    if ((value & static_cast<T>(~known)) != 0) fail(DecodeError::bad_value);
  }
  void reason(RefusedReason& value) {
    std::uint8_t byte = 0;
    integer(byte);
    value = static_cast<RefusedReason>(byte);
    if (value < RefusedReason::busy || value > RefusedReason::bad_request) fail(DecodeError::bad_value);
  }
  void text(std::array<char, kMaxReasonBytes>& characters, std::size_t& length) {
    for (char& character : characters) {
      std::uint8_t byte = 0;
      integer(byte);
      character = static_cast<char>(byte);
    }
    std::uint8_t byte = 0;
    integer(byte);
    length = std::min<std::size_t>(byte, characters.size());
    const bool padded = std::all_of(characters.begin() + static_cast<std::ptrdiff_t>(length), characters.end(),
                                    [](char character) { return character == '\0'; });
    if (byte > characters.size() || !padded) fail(DecodeError::bad_value);
  }

  void fail(DecodeError error) {
    if (error_ == DecodeError::none) error_ = error;
  }
  std::size_t left() const { return bytes_.size(); }
  DecodeError error() const { return error_; }

 private:
  std::span<const std::byte> bytes_;
  DecodeError error_ = DecodeError::none;
};

// The kind on the wire counts from 1 in the order of the variant.
template <class Message>
DecodeError read_payload(Reader& reader, std::uint64_t session, Datagram& out) {
  Message message{};
  message.session = session;
  walk(reader, message);
  if (reader.error() == DecodeError::none && reader.left() > 0) reader.fail(DecodeError::too_long);
  if (reader.error() == DecodeError::none) out = message;
  return reader.error();
}

template <std::size_t... index>
DecodeError read_kind(std::uint8_t kind, Reader& reader, std::uint64_t session, Datagram& out,
                      std::index_sequence<index...>) {
  DecodeError error = DecodeError::bad_kind;
  ((kind == index + 1 ? void(error = read_payload<std::variant_alternative_t<index, Datagram>>(reader, session, out))
                      : void()),
   ...);
  return error;
}

}  // namespace

std::string_view describe(DecodeError error) {
  switch (error) {
    case DecodeError::none:
      return "a whole Kenaf datagram";
    case DecodeError::too_short:
      return "Kenaf datagram cut short";
    case DecodeError::too_long:
      return "Kenaf datagram with bytes left over after its last field";
    case DecodeError::bad_magic:
      return "not a Kenaf datagram (bad magic)";
    case DecodeError::bad_version:
      return "Kenaf datagram of another protocol version (library and relay must match)";
    case DecodeError::bad_kind:
      return "Kenaf datagram of an unknown kind";
    case DecodeError::bad_session:
      return "Kenaf datagram without a session (session 0)";
    case DecodeError::not_finite:
      return "Kenaf datagram with a number that is NaN or infinite";
    case DecodeError::bad_value:
      return "Kenaf datagram with a flag or enumeration out of its range";
  }
  return "unknown error of a Kenaf datagram";
}

std::size_t encode(const Datagram& datagram, std::span<std::byte> out) {
  Writer writer(out);
  std::visit(
      [&](auto message) {
        writer.integer(kMagic);
        writer.integer(kVersion);
        writer.integer(static_cast<std::uint8_t>(datagram.index() + 1));
        writer.integer(std::uint16_t{0});  // the length, known at the end
        writer.integer(message.session);
        walk(writer, message);
      },
      datagram);
  Writer(out.subspan(kLengthOffset)).integer(static_cast<std::uint16_t>(writer.used()));
  return writer.used();
}

DecodeError decode(std::span<const std::byte> bytes, Datagram& out) {
  if (bytes.size() < kHeaderBytes) return DecodeError::too_short;
  Reader reader(bytes);
  std::uint32_t magic = 0;
  std::uint8_t version = 0;
  std::uint8_t kind = 0;
  std::uint16_t length = 0;
  std::uint64_t session = 0;
  reader.integer(magic);
  reader.integer(version);
  reader.integer(kind);
  reader.integer(length);
  reader.integer(session);
  if (magic != kMagic) return DecodeError::bad_magic;
  if (version != kVersion) return DecodeError::bad_version;
  if (kind == 0 || kind > std::variant_size_v<Datagram>) return DecodeError::bad_kind;
  if (bytes.size() < length) return DecodeError::too_short;
  if (bytes.size() > length) return DecodeError::too_long;
  if (session == 0) return DecodeError::bad_session;
  return read_kind(kind, reader, session, out, std::make_index_sequence<std::variant_size_v<Datagram>>{});
}

}  // namespace kenaf::protocol::relay
