// How a range scan's resolution and field of view are written. Clients of USARSim count the values by them:
// int(FOV / Resolution) + 1. The historic servers cut digits off, 3.1415 / 0.0174, which gives 181 for a scan of 181
// values; rounded, 3.1416 / 0.0175 gives 180. Sources: a recorded log of a UT2004 server; RangeScanner.uc of UDK's.
//
// Thread safety: a pure function.
#pragma once

#include "formats/protocol/usarsim_message.hpp"
#include "physics/robot_description.hpp"

namespace kenaf::world_server {

struct ScanAngles {
  double resolution_rad, field_of_view_rad;
  protocol::usarsim::NumberFormat format;  // of both
};

// The scanner's angles, for numbers in `format`. If it cuts digits off, the quotient counts the values: with more
// digits than asked for where these are too few, as for 541 values over 270 degrees.
ScanAngles scan_angles(const physics::SensorDescription& scanner, protocol::usarsim::NumberFormat format);

}  // namespace kenaf::world_server
