// A classic CAN frame with an 11-bit identifier, as used by CANopen, and the little-endian numbers in it.
//
// CANopen's standards, as cited in this room: CiA 301 version 4.2 (application layer), CiA 402 (IEC 61800-7-201,
// drives), CiA 410 (inclinometers). Everything in this room is free of sockets and clocks: frames and times go in,
// frames come out.
//
// Thread safety: values and pure functions.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <span>

namespace kenaf::canopen {

// Time since an arbitrary moment that is fixed while the program runs; monotonic.
using Time = std::chrono::nanoseconds;

inline constexpr std::uint8_t kMaxFrameBytes = 8;

struct Frame {
  std::uint16_t id = 0;                             // 0 to 0x7ff: CANopen's COB-ID
  std::uint8_t length = 0;                          // 0 to 8
  std::array<std::uint8_t, kMaxFrameBytes> data{};  // 0 beyond length
  bool remote = false;  // asks for a frame of this identifier, without data: CANopen's node guarding alone does so
  bool operator==(const Frame&) const = default;
};

// Returns Frame{id, data.size(), data}. Throws std::length_error for more than eight bytes, a defect of the caller.
Frame make_frame(std::uint16_t id, std::span<const std::uint8_t> data);

// Reads `bytes` (1 to 4) little-endian bytes from `at`; the caller must check that they exist.
std::uint32_t get_unsigned(std::span<const std::uint8_t> data, std::size_t at, std::size_t bytes);
std::int32_t get_signed(std::span<const std::uint8_t> data, std::size_t at, std::size_t bytes);
// Two's complement for negative values; truncated to `bytes`.
void put(std::span<std::uint8_t> data, std::size_t at, std::size_t bytes, std::uint32_t value);

// Returns the signed number of `bits` bits at `first_bit`; nullopt if the frame is too short.
std::optional<std::int32_t> bits_of(const Frame& frame, unsigned first_bit, unsigned bits);

// Bits of the frame on the wire, with the maximum of stuff bits and the three-bit interframe space: 47 + 8 n +
// floor((34 + 8 n - 1) / 4) (Tindell and Burns, "Guaranteeing message latencies on CAN", 1994, as corrected by Davis et
// al., "Controller Area Network schedulability analysis", 2007, eq. 2).
int worst_case_bits(const Frame& frame);

}  // namespace kenaf::canopen
