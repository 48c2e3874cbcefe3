// Emergency messages: report an error when it occurs and when it has gone. CiA 301, 7.2.7; codes: CiA 301 table 26 and
// CiA 402-2, error codes (IEC 61800-7-201, 7.4). Thread safety: values and pure functions.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "can/canopen/nmt.hpp"

namespace kenaf::canopen {

struct Emergency {
  NodeId node;
  std::uint16_t error_code;     // 0: an error has gone
  std::uint8_t error_register;  // object 0x1001; 0: no error is left
  std::array<std::uint8_t, 5> manufacturer_bytes{};
};

Frame encode(const Emergency& emergency);
// nullopt: another identifier (0x80 itself is SYNC), or not eight bytes.
std::optional<Emergency> emergency_from(const Frame& frame);

// Returns the most specific text known for a code: its own, otherwise its group's (0x231x, then 0x23xx "current, device
// output side"), otherwise its class's; "unknown error" if there is none. 0x00xx: "no error".
std::string_view error_code_words(std::uint16_t code);

// "0x2310 continuous over current (error register 0x03: generic, current; manufacturer 01 00 00 00 00)".
std::string describe(const Emergency& emergency);

// Codes that this project's own programs send or check.
inline constexpr std::uint16_t kErrorNone = 0x0000, kErrorContinuousOverCurrent = 0x2310,
                               kErrorOverTemperature = 0x4310, kErrorOverrun = 0x8110, kErrorHeartbeat = 0x8130,
                               kErrorPdoTooShort = 0x8210, kErrorSyncLength = 0x8240, kErrorPdoTimeOut = 0x8250,
                               kErrorFollowing = 0x8611;

}  // namespace kenaf::canopen
