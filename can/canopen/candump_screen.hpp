// A frame as candump prints it on the screen, without -L. The interface's name is in front of it.
//
//   123   [2]  11 22                          a data frame; eight digits: an identifier of 29 bits
//   123   [2]  11 22            '.".'         with -a; the characters are ignored
//   123   [2]  00010001 00100010              with -i
//   RX B E  123  [12]  11 22 ...              with -x; two digits of a length: CAN FD
//   123   {E}  11 22 33 44 55 66 77 88        with -8: a raw length code
//   701   [0]  remote request
//   20000040   [8]  00 00 00 00 00 00 00 00   ERRORFRAME
//
// Bytes in reverse order (-S, with '`' between them) are refused. Format: can-utils, candump.c and lib.c.
#pragma once

#include <string_view>

#include "can/canopen/recorded_frame.hpp"

namespace kenaf::canopen {

// True if the text has a length in brackets, by which frames of this form can be told.
bool is_candump_screen(std::string_view text);

// Sets kind, frame and error class. Throws BadLogLine.
void parse_candump_screen(std::string_view text, RecordedFrame& line);

}  // namespace kenaf::canopen
