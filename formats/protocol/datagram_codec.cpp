#include "formats/protocol/datagram_codec.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kenaf::protocol {

namespace {

static_assert(std::numeric_limits<double>::is_iec559 && sizeof(double) == 8);

constexpr std::size_t kHeaderBytes = 16;
constexpr std::size_t kLengthOffset = 6;

}  // namespace

std::string_view describe(DecodeError error) {
  switch (error) {
    case DecodeError::none:
      return "a whole datagram";
    case DecodeError::too_short:
      return "a datagram cut short";
    case DecodeError::too_long:
      return "a datagram with bytes left over after its last field";
    case DecodeError::bad_magic:
      return "not a datagram of this protocol (bad magic)";
    case DecodeError::bad_version:
      return "a datagram of another protocol version (both ends must match)";
    case DecodeError::bad_kind:
      return "a datagram of an unknown kind";
    case DecodeError::bad_session:
      return "a datagram without a session (session 0)";
    case DecodeError::not_finite:
      return "a datagram with a number that is NaN or infinite";
    case DecodeError::out_of_range:
      return "a datagram with a number out of its range";
    case DecodeError::bad_value:
      return "a datagram with a flag, enumeration or text that is none";
  }
  return "unknown error of a datagram";
}

void DatagramWriter::begin(const DatagramProtocol& protocol, std::uint8_t kind, std::uint64_t session) {
  integer(protocol.magic);
  integer(protocol.version);
  integer(kind);
  integer(std::uint16_t{0});  // the length, known at the end
  integer(session);
}

std::size_t DatagramWriter::end() {
  DatagramWriter(out_.subspan(kLengthOffset)).integer(static_cast<std::uint16_t>(used_));
  return used_;
}

void DatagramWriter::number(double value, double limit) {
  number(std::isnan(value) ? 0.0 : std::clamp(value, -limit, limit));
}

void DatagramWriter::padded(std::span<const char> characters, std::size_t length) {
  for (std::size_t i = 0; i < characters.size(); ++i) {
    integer(static_cast<std::uint8_t>(i < length ? characters[i] : '\0'));
  }
}

void DatagramWriter::text_and_length(std::span<const char> characters, std::size_t length) {
  padded(characters, length);
  integer(static_cast<std::uint8_t>(std::min(length, characters.size())));
}

void DatagramWriter::length_and_text(std::size_t length, std::span<const char> characters) {
  integer(static_cast<std::uint8_t>(std::min(length, characters.size())));
  padded(characters, length);
}

void DatagramReader::begin(const DatagramProtocol& protocol, std::size_t kinds, std::uint8_t& kind,
                           std::uint64_t& session) {
  const std::size_t size = bytes_.size();
  if (size < kHeaderBytes) return fail(DecodeError::too_short);
  std::uint32_t magic = 0;
  std::uint8_t version = 0;
  std::uint16_t length = 0;
  integer(magic);
  integer(version);
  integer(kind);
  integer(length);
  integer(session);
  // The first that is wrong counts: bytes of another protocol are told as such, whatever else is wrong with them.
  if (magic != protocol.magic) return fail(DecodeError::bad_magic);
  if (version != protocol.version) return fail(DecodeError::bad_version);
  if (kind == 0 || kind > kinds) return fail(DecodeError::bad_kind);
  if (size < length) return fail(DecodeError::too_short);
  if (size > length) return fail(DecodeError::too_long);
  if (session == 0) return fail(DecodeError::bad_session);
}

DecodeError DatagramReader::end() {
  if (!bytes_.empty()) fail(DecodeError::too_long);
  return error_;
}

void DatagramReader::counter(std::uint32_t& value) {
  integer(value);
  if (value == 0) fail(DecodeError::out_of_range);
}

void DatagramReader::number(double& value) {
  std::uint64_t pattern = 0;
  integer(pattern);
  value = std::bit_cast<double>(pattern);
  if (!std::isfinite(value)) fail(DecodeError::not_finite);
}

void DatagramReader::number(double& value, double limit) {
  number(value);
  if (std::abs(value) > limit) fail(DecodeError::out_of_range);
}

void DatagramReader::flag(bool& value) {
  std::uint8_t byte = 0;
  integer(byte);
  check(byte <= 1);
  value = byte == 1;
}

void DatagramReader::raw(std::span<char> characters) {
  for (char& character : characters) {
    std::uint8_t byte = 0;
    integer(byte);
    character = static_cast<char>(byte);
  }
}

void DatagramReader::take_length(std::uint8_t byte, std::span<const char> characters, std::size_t& length) {
  length = std::min<std::size_t>(byte, characters.size());
  check(byte <= characters.size());
  check(std::ranges::all_of(characters.subspan(length), [](char character) { return character == '\0'; }));
}

void DatagramReader::text_and_length(std::span<char> characters, std::size_t& length) {
  std::uint8_t byte = 0;
  raw(characters);
  integer(byte);
  take_length(byte, characters, length);
}

void DatagramReader::length_and_text(std::size_t& length, std::span<char> characters) {
  std::uint8_t byte = 0;
  integer(byte);
  raw(characters);
  take_length(byte, characters, length);
}

}  // namespace kenaf::protocol
