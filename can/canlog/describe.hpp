// Describes each frame of a bus in one line, for readers of a log.
#pragma once

#include <string>

#include "can/canlog/log.hpp"
#include "can/canlog/network.hpp"

namespace kenaf::canlog {

// "NMT start flipper rear left", "track left: operation enabled, position 1234 counts (0.0034 m)". Depends on the frame
// alone; a frame that does not fit its identifier is described as such.
std::string describe(const canopen::Frame& frame, const Network& network);
// The same for any line; lines that are no data frames are described by their kind.
std::string describe(const LogFrame& logged, const Network& network);

}  // namespace kenaf::canlog
