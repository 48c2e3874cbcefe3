// One line of a recorded bus, as can-utils' `candump -L` writes it and canplayer reads it:
//
//   (1436509052.249713) vcan0 1A5#2C01            a data frame with an identifier of 11 bits: three digits
//   (1436509052.249713) vcan0 000001A5#2C01       ... of 29 bits: eight digits
//   (1436509052.249713) vcan0 1A5#R2              a remote frame, asking for two bytes; R alone: for none
//   (1436509052.249713) vcan0 1A5##12C01          CAN FD: flags (one digit), then up to 64 bytes
//   (1436509052.249713) vcan0 20000004#000C000000000000    an error message of the driver: bit 29 of eight digits
//
// Bytes may be separated by '.'; a classic frame of eight bytes may end in '_' and a raw length code of 9 to F; newer
// versions end the line in " T" or " R", sent or received. CANopen uses only data frames with 11-bit identifiers: the
// other kinds are recognised but not decoded. Format: can-utils, lib.h and log2asc.c.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

#include "can/canopen/frame.hpp"

namespace kenaf::canopen {

enum class CandumpKind : std::uint8_t { data, extended, remote, fd, error };
std::string_view describe(CandumpKind kind);  // "a CAN FD frame"

struct CandumpLine {
  Time at;  // by the recording clock; candump: since 1970
  std::string interface;
  CandumpKind kind;
  Frame frame{};  // for kind data; otherwise empty
};

// The error in a line.
class BadCandumpLine : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Parses one line without its end; leading and trailing blanks are ignored. Throws BadCandumpLine.
CandumpLine parse_candump_line(std::string_view line);

// Formats a line with microseconds and without line end. `at` must not be negative.
std::string candump_line(Time at, std::string_view interface, const Frame& frame);

}  // namespace kenaf::canopen
