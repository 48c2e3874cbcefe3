// An entry of an object dictionary: address, type, and value as on the wire. CiA 301, 7.4.
#pragma once

#include <compare>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace kenaf::canopen {

struct ObjectAddress {
  std::uint16_t index = 0;
  std::uint8_t sub = 0;
  auto operator<=>(const ObjectAddress&) const = default;
};
std::string to_string(ObjectAddress address);  // "0x6040:00"

enum class ObjectType : std::uint8_t { unsigned8, unsigned16, unsigned32, integer8, integer16, integer32, text };
std::size_t byte_count(ObjectType type);  // 1, 2, 4; 0 for text: any length
bool is_signed(ObjectType type);

using ObjectBytes = std::vector<std::uint8_t>;  // little-endian

// Encodes a number in the type's bytes. Throws std::out_of_range, with type and value, if it does not fit; not for
// text.
ObjectBytes encode_number(ObjectType type, std::int64_t value);
// The same into the first bytes of `to`, without allocating; returns their count.
std::size_t write_number(ObjectType type, std::int64_t value, std::span<std::uint8_t> to);
// Decodes a number; the caller must check that there are byte_count(type) bytes.
std::int64_t decode_number(ObjectType type, std::span<const std::uint8_t> bytes);

}  // namespace kenaf::canopen
