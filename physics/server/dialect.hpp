// The two historic dialects of the USARSim protocol, as far as they write numbers differently. Sources: recorded lines
// of a UT2004 server (2007) and of a UDK server (2014), and the UDK server's sensor classes.
// Thread safety: values.
#pragma once

#include "protocol/usarsim_message.hpp"

namespace kenaf::server {

enum class Dialect { ut2004, udk };

struct Formats {
  usarsim::NumberFormat status_time;   // STA, MISSTA
  usarsim::NumberFormat scan_time;     // SEN RangeScanner
  usarsim::NumberFormat sensor_time;   // every other SEN; RES, PONG
  usarsim::NumberFormat ground_truth;  // Location and Orientation
  usarsim::NumberFormat ins;
  usarsim::NumberFormat scan;   // ranges of a RangeScanner
  usarsim::NumberFormat value;  // everything else
};

Formats formats_of(Dialect dialect);
// The same number of digits for everything, rounded.
Formats formats_with(int decimals);

}  // namespace kenaf::server
