// Shared by both ends of a service data object transfer: abort codes. CiA 301, 7.2.4.
#pragma once

#include <cstdint>
#include <string_view>

#include "can/canopen/object.hpp"

namespace kenaf::canopen {

// The largest value accepted by either end: longer than any text of a drive, and memory stays bounded.
inline constexpr std::size_t kMaxSdoBytes = 1024;

enum class SdoAbort : std::uint32_t {
  toggle_bit = 0x05030000,
  timed_out = 0x05040000,
  bad_command = 0x05040001,
  out_of_memory = 0x05040005,
  unsupported_access = 0x06010000,
  write_only = 0x06010001,
  read_only = 0x06010002,
  no_object = 0x06020000,
  cannot_be_mapped = 0x06040041,
  pdo_too_long = 0x06040042,
  incompatible_parameter = 0x06040043,
  wrong_length = 0x06070010,
  too_long = 0x06070012,
  too_short = 0x06070013,
  no_sub_index = 0x06090011,
  invalid_value = 0x06090030,
  value_too_high = 0x06090031,
  value_too_low = 0x06090032,
  general = 0x08000000,
  cannot_be_stored = 0x08000020,
  not_in_this_state = 0x08000022,
};

// CiA 301's text for a code, table 22; "unknown abort code" for any other.
std::string_view describe(SdoAbort code);

}  // namespace kenaf::canopen
