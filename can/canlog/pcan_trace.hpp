// Traces of PEAK's PCAN-View and PCAN-Explorer (.trc), versions 1.1, 2.0 and 2.1:
//
//   ;$FILEVERSION=1.1                                    ;$FILEVERSION=2.1
//   ;   1)      1841.5  Rx  0701  1  7F                  ;$COLUMNS=N,O,T,B,I,d,R,L,D
//   number, ms since the start, type, identifier,             1      1841.500 DT 1  0701 Rx -  1    7F
//   length, bytes (or RTR)
//
// Identifiers of four hexadecimal digits have 11 bits, longer ones 29. Warnings and status lines become error messages
// of a CAN driver. Source: PEAK CAN TRC File Format, 2020.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "can/canopen/recorded_frame.hpp"

namespace kenaf::canlog {

class PcanTrace {
 public:
  // Takes the lines of a file in their order. nullopt: a line without a frame. The interface is the bus, "1" where the
  // version has none. Throws canopen::BadLogLine for a line that cannot be read, std::runtime_error for a version that
  // cannot.
  std::optional<canopen::RecordedFrame> read(std::string_view line);

 private:
  using Words = std::span<const std::string_view>;
  void read_header(std::string_view line);
  std::string_view column(Words words, char letter) const;
  void read_frame(Words words, std::string_view type, canopen::RecordedFrame& line) const;

  std::string version_{};
  std::string columns_{};  // a letter for each, as $COLUMNS has them
};

}  // namespace kenaf::canlog
