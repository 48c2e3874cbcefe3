#include "can/canlog/pdo_in_force.hpp"

#include <algorithm>
#include <array>

namespace kenaf::canlog {

using canopen::ObjectType;

namespace {

// Signed objects of CiA 402-2 and CiA 410.
constexpr std::array<std::uint16_t, 13> kSigned{0x6010, 0x6020, 0x6064, 0x606c, 0x6071, 0x6077, 0x6078,
                                                0x607a, 0x60ff, 0x60f4, 0x6110, 0x6120, 0x6060};

}  // namespace

std::optional<canopen::MappedObject> mapped_object(std::uint32_t entry) {
  const canopen::ObjectAddress object{static_cast<std::uint16_t>(entry >> 16), static_cast<std::uint8_t>(entry >> 8)};
  const bool is_signed = std::ranges::find(kSigned, object.index) != kSigned.end();
  switch (entry & 0xff) {
    case 8:
      return canopen::MappedObject{object, is_signed ? ObjectType::integer8 : ObjectType::unsigned8};
    case 16:
      return canopen::MappedObject{object, is_signed ? ObjectType::integer16 : ObjectType::unsigned16};
    case 32:
      return canopen::MappedObject{object, is_signed ? ObjectType::integer32 : ObjectType::unsigned32};
    default:
      return std::nullopt;
  }
}

std::vector<std::int64_t> values_of(const PdoInForce& pdo, const canopen::Frame& frame) {
  if (pdo.objects.empty() || frame.length != pdo.bytes) return {};
  const std::span<const std::uint8_t> data(frame.data);
  std::vector<std::int64_t> values;
  std::size_t at = 0;
  for (const canopen::MappedObject& mapped : pdo.objects) {
    const std::size_t bytes = byte_count(mapped.type);
    values.push_back(decode_number(mapped.type, data.subspan(at, bytes)));
    at += bytes;
  }
  return values;
}

std::optional<std::int64_t> value_of(const PdoInForce& pdo, const canopen::Frame& frame,
                                     canopen::ObjectAddress object) {
  const auto found = std::ranges::find(pdo.objects, object, &canopen::MappedObject::object);
  const std::vector<std::int64_t> values = values_of(pdo, frame);
  if (found == pdo.objects.end() || values.empty()) return std::nullopt;
  return values[static_cast<std::size_t>(found - pdo.objects.begin())];
}

}  // namespace kenaf::canlog
