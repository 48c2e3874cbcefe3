// Objects that every CANopen device has, and those of an inclinometer. CiA 301, 7.5.2; CiA 410, 5.
//
// Thread safety: constants and pure functions.
#pragma once

#include <cstdint>

#include "can/canopen/pdo.hpp"

namespace kenaf::canopen {

// Object 0x1000: the lower 16 bits are the number of the device profile.
inline constexpr std::uint16_t kProfileDrive = 402, kProfileInclinometer = 410;
constexpr std::uint16_t profile_of(std::uint32_t device_type) {
  return static_cast<std::uint16_t>(device_type & 0xffff);
}

// Object 0x1016, a consumer heartbeat entry: node in bits 16 to 22, time in ms in bits 0 to 15.
constexpr std::uint32_t consumer_heartbeat(std::uint8_t node, std::uint16_t time_ms) {
  return static_cast<std::uint32_t>(node) << 16 | time_ms;
}

namespace object {
inline constexpr MappedObject device_type{{0x1000, 0}, ObjectType::unsigned32},
    error_register{{0x1001, 0}, ObjectType::unsigned8}, guard_time_ms{{0x100c, 0}, ObjectType::unsigned16},
    life_time_factor{{0x100d, 0}, ObjectType::unsigned8}, emergency_id{{0x1014, 0}, ObjectType::unsigned32},
    consumer_heartbeat_count{{0x1016, 0}, ObjectType::unsigned8},
    consumer_heartbeat_1{{0x1016, 1}, ObjectType::unsigned32},
    producer_heartbeat_ms{{0x1017, 0}, ObjectType::unsigned16}, vendor_id{{0x1018, 1}, ObjectType::unsigned32},
    product_code{{0x1018, 2}, ObjectType::unsigned32}, revision{{0x1018, 3}, ObjectType::unsigned32},
    serial_number{{0x1018, 4}, ObjectType::unsigned32},
    communication_error_behaviour{{0x1029, 1}, ObjectType::unsigned8};  // 1: no change of the NMT state
inline constexpr ObjectAddress device_name{0x1008, 0};                  // text

// CiA 410: slopes in units of the resolution, object 0x6000, which is in thousandths of a degree (1, 10, 100 or 1000).
inline constexpr MappedObject slope_resolution{{0x6000, 0}, ObjectType::unsigned16},
    slope_longitudinal{{0x6010, 0}, ObjectType::integer16}, slope_lateral{{0x6020, 0}, ObjectType::integer16},
    slope_longitudinal_32{{0x6110, 0}, ObjectType::integer32}, slope_lateral_32{{0x6120, 0}, ObjectType::integer32};
}  // namespace object

}  // namespace kenaf::canopen
