// One line of a recorded bus, as can-utils' candump prints it. With -L, which canplayer reads too:
//
//   (1436509052.249713) vcan0 1A5#2C01            a data frame with an identifier of 11 bits: three digits
//   (1436509052.249713) vcan0 000001A5#2C01       ... of 29 bits: eight digits
//   (1436509052.249713) vcan0 1A5#R2              a remote frame, asking for two bytes; R alone: for none
//   (1436509052.249713) vcan0 1A5##12C01          CAN FD: flags (one digit), then up to 64 bytes
//   (1436509052.249713) vcan0 20000004#000C000000000000    an error message of the driver: bit 29 of eight digits
//
// Bytes may be separated by '.'; a classic frame of eight bytes may end in '_' and a raw length code of 9 to F; newer
// versions end the line in " T" or " R", sent or received. Without -L: candump_screen.hpp, with or without a time in
// front. Times: candump_stamp.hpp. CANopen uses only identifiers of 11 bits: frames with 29 bits and CAN FD frames are
// recognised but not decoded. Format: can-utils, lib.h and log2asc.c. Pure functions.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "can/canopen/recorded_frame.hpp"

namespace kenaf::canopen {

// Parses one line without its end; leading and trailing blanks and colours of a terminal are ignored. Throws
// BadLogLine.
RecordedFrame parse_candump_line(std::string_view line);

// Formats a line with microseconds and without line end. `at` must not be negative.
std::string candump_line(Time at, std::string_view interface, const Frame& frame);

// An identifier of candump: three hexadecimal digits, or eight; the error flag removed.
struct CandumpId {
  std::uint32_t id;
  bool extended, error;
};
// Throws BadLogLine.
CandumpId parse_candump_id(std::string_view digits);
// A classic frame with these bytes, at most eight: kind, frame and error class of `line`.
void set_frame(RecordedFrame& line, CandumpId id, std::span<const std::uint8_t> bytes);

}  // namespace kenaf::canopen
