// The time in front of a line of candump, by its option -t:
//
//   (1436509052.249713)             -ta, and -L by itself: seconds since 1970
//   (2015-07-10 06:17:32.249713)    -tA: the same by the calendar of the recorder's time zone
//   (001.249713)                    -tz: since the first frame; -td: since the frame before. Three digits at least.
//
// Format: can-utils, candump.c. Pure functions.
#pragma once

#include <string_view>

#include "can/canopen/recorded_frame.hpp"

namespace kenaf::canopen {

struct CandumpStamp {
  Time at{};  // calendar times: since 1970 as if the recorder's time zone were UTC
  Stamp stamp = Stamp::none;
};

// Removes the stamp from the beginning of `line`; Stamp::none if the line does not begin with '('. Throws BadLogLine if
// what is in brackets is not a time.
CandumpStamp take_candump_stamp(std::string_view& line);

}  // namespace kenaf::canopen
