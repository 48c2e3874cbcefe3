#include "link.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <concepts>
#include <limits>
#include <utility>

namespace kenaf::teleop {

namespace {

static_assert(std::numeric_limits<double>::is_iec559 && sizeof(double) == 8);

// Header: u32 magic, u8 version, u8 kind, u16 length of the whole datagram, u64 session. All little-endian.
constexpr std::size_t kHeaderBytes = 16;
constexpr std::size_t kLengthOffset = 6;

constexpr std::uint8_t kFlipperBits = (1u << kFlipperCount) - 1;
constexpr std::uint32_t kMeasuredBits = (kHasPose << 1) - 1;
constexpr std::uint32_t kFlagBits = (kDegraded << 1) - 1;

bool is_printable(char character) {
  return character >= ' ' && character <= '~';
}

// Each overload lists the payload of one kind in wire order. The Writer and the Reader walk the same list, so they
// cannot disagree. The session is part of the header.
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
  io.text(m.message);
  io.text(m.warning);
}

void walk(auto& io, Taken& m) {
  io.text(m.by);
}

void walk(auto&, Bye&) {}

class Writer {
 public:
  explicit Writer(std::span<std::byte> out) : out_(out) {}

  void integer(std::unsigned_integral auto value) {
    assert(used_ + sizeof value <= out_.size());
    for (std::size_t i = 0; i < sizeof value; ++i) out_[used_++] = static_cast<std::byte>((value >> (8 * i)) & 0xff);
  }
  void counter(std::uint32_t value) { integer(value); }
  void number(double value, double limit) {
    integer(std::bit_cast<std::uint64_t>(std::isnan(value) ? 0.0 : std::clamp(value, -limit, limit)));
  }
  template <std::size_t n>
  void numbers(const std::array<double, n>& values, double limit) {
    for (const double value : values) number(value, limit);
  }
  void flag(bool value) { integer(std::uint8_t{value}); }
  template <std::unsigned_integral T>
  void bits(T value, T known) {
    integer(static_cast<T>(value & known));
  }
  template <class Choice>
  void choice(Choice value, Choice) {
    integer(static_cast<std::uint8_t>(value));
  }
  void text(const Text& text) {
    integer(static_cast<std::uint8_t>(text.length));
    for (const char character : text.characters) integer(static_cast<std::uint8_t>(character));
  }
  std::size_t used() const { return used_; }

 private:
  std::span<std::byte> out_;
  std::size_t used_ = 0;
};

// Keeps the first error; values read after it are 0.
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
  void counter(std::uint32_t& value) {
    integer(value);
    if (value == 0) fail(DecodeError::out_of_range);
  }
  void number(double& value, double limit) {
    std::uint64_t pattern = 0;
    integer(pattern);
    value = std::bit_cast<double>(pattern);
    if (!std::isfinite(value)) return fail(DecodeError::not_finite);
    if (std::abs(value) > limit) fail(DecodeError::out_of_range);
  }
  template <std::size_t n>
  void numbers(std::array<double, n>& values, double limit) {
    for (double& value : values) number(value, limit);
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
  template <class Choice>
  void choice(Choice& value, Choice last) {
    std::uint8_t byte = 0;
    integer(byte);
    if (byte == 0 || byte > static_cast<std::uint8_t>(last)) fail(DecodeError::bad_value);
    value = static_cast<Choice>(byte);
  }
  void text(Text& text) {
    std::uint8_t length = 0;
    integer(length);
    for (char& character : text.characters) {
      std::uint8_t byte = 0;
      integer(byte);
      character = static_cast<char>(byte);
    }
    text.length = std::min<std::size_t>(length, kMaxTextBytes);
    const auto end = text.characters.begin() + static_cast<std::ptrdiff_t>(text.length);
    const bool printable = std::all_of(text.characters.begin(), end, is_printable);
    const bool padded = std::all_of(end, text.characters.end(), [](char character) { return character == '\0'; });
    if (length > kMaxTextBytes || !printable || !padded) fail(DecodeError::bad_value);
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

// The kind on the wire is the index in the variant plus 1.
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

std::string_view describe(DecodeError error) {
  switch (error) {
    case DecodeError::none:
      return "a whole operator's datagram";
    case DecodeError::too_short:
      return "operator's datagram cut short";
    case DecodeError::too_long:
      return "operator's datagram with bytes left over after its last field";
    case DecodeError::bad_magic:
      return "not an operator's datagram (bad magic)";
    case DecodeError::bad_version:
      return "operator's datagram of another version (console and control process must match)";
    case DecodeError::bad_kind:
      return "operator's datagram of an unknown kind";
    case DecodeError::bad_session:
      return "operator's datagram without a session (session 0)";
    case DecodeError::not_finite:
      return "operator's datagram with a number that is NaN or infinite";
    case DecodeError::out_of_range:
      return "operator's datagram with a number out of its range";
    case DecodeError::bad_value:
      return "operator's datagram with an invalid flag, enumeration or text";
  }
  return "unknown error of an operator's datagram";
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

}  // namespace kenaf::teleop
