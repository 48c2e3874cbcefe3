// The two historic dialects of the USARSim protocol, as far as their number formats differ. Sources: recorded lines of
// a UT2004 server (2007) and of a UDK server (2014), and the UDK server's sensor classes.
//
// Thread safety: values.
#pragma once

#include "formats/protocol/usarsim_message.hpp"

namespace kenaf::world_server {

enum class Dialect { ut2004, udk };

struct Formats {
  protocol::usarsim::NumberFormat status_time;   // STA, MISSTA
  protocol::usarsim::NumberFormat scan_time;     // SEN RangeScanner
  protocol::usarsim::NumberFormat sensor_time;   // every other SEN; RES, PONG
  protocol::usarsim::NumberFormat ground_truth;  // Location and Orientation
  protocol::usarsim::NumberFormat ins;
  protocol::usarsim::NumberFormat scan;        // ranges of a RangeScanner
  protocol::usarsim::NumberFormat scan_angle;  // its resolution and field of view
  protocol::usarsim::NumberFormat value;       // everything else
};

Formats formats_of(Dialect dialect);
// The same number of decimals for everything, rounded.
Formats formats_with(int decimals);

}  // namespace kenaf::world_server
