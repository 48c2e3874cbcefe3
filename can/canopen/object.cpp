#include "can/canopen/object.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "can/canopen/frame.hpp"

namespace kenaf::canopen {

std::string to_string(ObjectAddress address) {
  return fmt::format("{:#06x}:{:02x}", address.index, address.sub);
}

std::size_t byte_count(ObjectType type) {
  switch (type) {
    case ObjectType::unsigned8:
    case ObjectType::integer8:
      return 1;
    case ObjectType::unsigned16:
    case ObjectType::integer16:
      return 2;
    case ObjectType::unsigned32:
    case ObjectType::integer32:
      return 4;
    case ObjectType::text:
      break;
  }
  return 0;
}

bool is_signed(ObjectType type) {
  return type == ObjectType::integer8 || type == ObjectType::integer16 || type == ObjectType::integer32;
}

std::size_t write_number(ObjectType type, std::int64_t value, std::span<std::uint8_t> to) {
  const std::size_t bytes = byte_count(type);
  const std::int64_t span = std::int64_t{1} << 8 * bytes;
  const std::int64_t min = is_signed(type) ? -span / 2 : 0;
  const std::int64_t max = min + span - 1;
  if (value < min || value > max)
    throw std::out_of_range(fmt::format("{} does not fit in {} bits {} sign ({} to {})", value, 8 * bytes,
                                        is_signed(type) ? "with" : "without", min, max));
  put(to, 0, bytes, static_cast<std::uint32_t>(value));
  return bytes;
}

ObjectBytes encode_number(ObjectType type, std::int64_t value) {
  ObjectBytes encoded(byte_count(type));
  write_number(type, value, encoded);
  return encoded;
}

std::int64_t decode_number(ObjectType type, std::span<const std::uint8_t> bytes) {
  if (is_signed(type)) return get_signed(bytes, 0, byte_count(type));
  return get_unsigned(bytes, 0, byte_count(type));
}

}  // namespace kenaf::canopen
