// Header, fields and decode errors that the project's binary datagrams share. A protocol (relay_datagram.hpp; the
// operator's link, teleop/link.hpp) has its messages as plain structs and lists each one's fields in one function,
// `walk`, which writes with a DatagramWriter and reads with a DatagramReader. So the two cannot disagree, and there is
// one way to write each message.
//
// On the wire everything is little-endian without padding, numbers are IEEE 754 doubles:
//   u32 magic, u8 version, u8 kind, u16 length of the whole datagram, u64 session; then the fields of the kind
// The kind is the message's place in the protocol's variant, counted from 1. The length is that of the received bytes.
// A session is chosen by the side that begins and is never 0.
//
// Units and ranges are the protocols'. Thread safety: values and pure functions. Nothing allocates.
#pragma once

#include <array>
#include <bit>
#include <cassert>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <utility>
#include <variant>

namespace kenaf::protocol {

enum class DecodeError : std::uint8_t {
  none = 0,
  too_short,     // shorter than the header, than its length or than its kind
  too_long,      // bytes after its length or after the last field
  bad_magic,     // of another protocol
  bad_version,   // of another version of the protocol
  bad_kind,      // of no kind of the protocol
  bad_session,   // session 0
  not_finite,    // a number is NaN or infinite
  out_of_range,  // a number beyond its limit, or a counter of 0
  bad_value,     // a flag, bit, enumeration or text that is none
};

// For a log line, such as "a datagram cut short", "not a datagram of this protocol (bad magic)".
std::string_view describe(DecodeError error);

// The beginning of every datagram of a protocol.
struct DatagramProtocol {
  std::uint32_t magic;
  std::uint8_t version;
};

// Writes fields one after the other. The bytes must have room for all of them.
class DatagramWriter {
 public:
  explicit DatagramWriter(std::span<std::byte> out) : out_(out) {}

  void begin(const DatagramProtocol& protocol, std::uint8_t kind, std::uint64_t session);
  // Puts the length into the header and returns it.
  std::size_t end();

  // Fields, as DatagramReader has them.
  void integer(std::unsigned_integral auto value) {
    assert(used_ + sizeof value <= out_.size());
    for (std::size_t i = 0; i < sizeof value; ++i) out_[used_++] = static_cast<std::byte>((value >> (8 * i)) & 0xff);
  }
  void counter(std::uint32_t value) { integer(value); }
  void number(double value) { integer(std::bit_cast<std::uint64_t>(value)); }
  // A number beyond the limit is written as the limit, NaN as 0, so that the receiver can read it.
  void number(double value, double limit);
  template <std::size_t n>
  void numbers(const std::array<double, n>& values, auto... limit) {
    for (const double value : values) number(value, limit...);
  }
  void flag(bool value) { integer(std::uint8_t{value}); }
  // Other bits than the known ones are not written.
  template <std::unsigned_integral T>
  void bits(T value, T known) {
    integer(static_cast<T>(value & known));
  }
  template <class Choice>
  void choice(Choice value, Choice) {
    integer(static_cast<std::uint8_t>(value));
  }
  // `length` beyond the characters counts as all of them; after `length` zeros are written.
  void text_and_length(std::span<const char> characters, std::size_t length);
  void length_and_text(std::size_t length, std::span<const char> characters);
  void check(bool) {}

 private:
  void padded(std::span<const char> characters, std::size_t length);

  std::span<std::byte> out_;
  std::size_t used_ = 0;
};

// Reads fields one after the other and keeps the first error; integers read after the end are 0.
class DatagramReader {
 public:
  explicit DatagramReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  // Reads the header. Fails unless the bytes are one datagram of `protocol`, of a kind from 1 to `kinds`.
  void begin(const DatagramProtocol& protocol, std::size_t kinds, std::uint8_t& kind, std::uint64_t& session);
  // Fails if bytes are left. Returns the first error.
  DecodeError end();

  template <std::unsigned_integral T>
  void integer(T& value) {
    value = 0;
    if (bytes_.size() < sizeof value) return fail(DecodeError::too_short);
    for (std::size_t i = 0; i < sizeof value; ++i) {
      value = static_cast<T>(value | static_cast<T>(std::to_integer<T>(bytes_[i]) << (8 * i)));
    }
    bytes_ = bytes_.subspan(sizeof value);
  }
  // An integer that counts from 1.
  void counter(std::uint32_t& value);
  // Finite; from -limit to limit if there is one.
  void number(double& value);
  void number(double& value, double limit);
  template <std::size_t n>
  void numbers(std::array<double, n>& values, auto... limit) {
    for (double& value : values) number(value, limit...);
  }
  // One byte, 0 or 1.
  void flag(bool& value);
  // No bits but the known ones.
  template <std::unsigned_integral T>
  void bits(T& value, T known) {
    integer(value);
    check((value & static_cast<T>(~known)) == 0);
  }
  // One byte: an enumeration that counts from 1 to `last`.
  template <class Choice>
  void choice(Choice& value, Choice last) {
    std::uint8_t byte = 0;
    integer(byte);
    check(byte != 0 && byte <= static_cast<std::uint8_t>(last));
    value = static_cast<Choice>(byte);
  }
  // As many characters as there is room for, zero padded, and one byte with the number of those that are the text.
  void text_and_length(std::span<char> characters, std::size_t& length);
  // The same, with the number first.
  void length_and_text(std::size_t& length, std::span<char> characters);
  // A further condition of the protocol on a field that was read.
  void check(bool fine) {
    if (!fine) fail(DecodeError::bad_value);
  }

  DecodeError error() const { return error_; }

 private:
  void fail(DecodeError error) {
    if (error_ == DecodeError::none) error_ = error;
  }
  void raw(std::span<char> characters);
  void take_length(std::uint8_t byte, std::span<const char> characters, std::size_t& length);

  std::span<const std::byte> bytes_;
  DecodeError error_ = DecodeError::none;
};

// Writes `datagram` into `out`, which must have room for the longest one, and returns the bytes used.
// `walk(io, message)` lists the fields of each kind; the session is of the header.
template <class... Message, class Walk>
std::size_t encode_datagram(const DatagramProtocol& protocol, const std::variant<Message...>& datagram,
                            std::span<std::byte> out, Walk walk) {
  DatagramWriter writer(out);
  std::visit(
      [&](auto message) {  // a copy, as walk() takes messages that it may also fill
        writer.begin(protocol, static_cast<std::uint8_t>(datagram.index() + 1), message.session);
        walk(writer, message);
      },
      datagram);
  return writer.end();
}

// Reads one datagram. On an error `out` is unchanged.
template <class... Message, class Walk>
DecodeError decode_datagram(const DatagramProtocol& protocol, std::span<const std::byte> bytes,
                            std::variant<Message...>& out, Walk walk) {
  DatagramReader reader(bytes);
  std::uint8_t kind = 0;
  std::uint64_t session = 0;
  reader.begin(protocol, sizeof...(Message), kind, session);
  if (reader.error() != DecodeError::none) return reader.error();
  const auto read = [&]<class One>(std::in_place_type_t<One>) {
    One message{};
    message.session = session;
    walk(reader, message);
    if (reader.end() == DecodeError::none) out = message;
  };
  std::uint8_t next = 0;
  ((++next == kind ? read(std::in_place_type<Message>) : void()), ...);
  return reader.error();
}

}  // namespace kenaf::protocol
