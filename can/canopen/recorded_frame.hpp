// One line of a recorded bus, whatever program recorded it.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

#include "can/canopen/frame.hpp"

namespace kenaf::canopen {

// CANopen uses data frames with identifiers of 11 bits, and remote frames as requests. `extended`: a data or remote
// frame with an identifier of 29 bits; `error`: no frame, but a message of the CAN driver about the wire.
enum class FrameKind : std::uint8_t { data, extended, remote, fd, error };
std::string_view describe(FrameKind kind);  // "a CAN FD frame"

// What a line's time counts from. `short_seconds` is how `candump -tz` writes the time since its first frame and
// `candump -td` the time since the frame before: a single line cannot tell which.
enum class Stamp : std::uint8_t { none, time, short_seconds };

struct RecordedFrame {
  Time at{};  // 0 for Stamp::none
  std::string interface {};
  FrameKind kind = FrameKind::data;
  Frame frame{};                  // data; remote: without bytes, its length is what is asked for; error: the message's
                                  // bytes; otherwise empty
  std::uint32_t error_class = 0;  // error: the bits of linux/can/error.h
  Stamp stamp = Stamp::time;
};

// The error in a line.
class BadLogLine : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace kenaf::canopen
