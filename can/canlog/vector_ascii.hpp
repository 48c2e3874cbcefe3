// Vector's ASCII logs (.asc), as CANoe, CANalyzer and python-can write them:
//
//   base hex  timestamps absolute
//   0.001000 1  701             Rx   d 1 7F          channel, identifier ("701x": 29 bits), data, length, bytes
//   0.002000 1  701             Rx   r 1             a remote frame
//   0.003000 1  ErrorFrame
//   0.004000 CAN 1 Status:chip status bus off
//   0.005000 CANFD 1 Rx 701 1 0 1 1 7f ...
//
// The interface is the channel's number. Events of other buses and programs, and orders to send ("TxRq"), are passed
// over. Relative times count from the event before. Source: Vector, CAN ASC Logging Files.
#pragma once

#include <optional>
#include <string_view>

#include "can/canopen/recorded_frame.hpp"

namespace kenaf::canlog {

class VectorAscii {
 public:
  // Takes the lines of a file in their order. nullopt: a line without a frame. Throws canopen::BadLogLine.
  std::optional<canopen::RecordedFrame> read(std::string_view line);

 private:
  void read_header(std::string_view line);
  std::optional<canopen::RecordedFrame> read_classic(std::string_view channel, std::string_view rest) const;
  canopen::RecordedFrame read_fd(std::string_view rest) const;
  std::uint32_t number(std::string_view digits, std::uint32_t most, std::string_view what) const;
  void set_id(canopen::RecordedFrame& line, std::string_view word) const;
  void take_data(canopen::RecordedFrame& line, std::string_view& rest, std::size_t count) const;

  bool hexadecimal_ = true, relative_ = false;
  canopen::Time last_{};
};

}  // namespace kenaf::canlog
