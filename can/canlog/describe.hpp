// What each frame of a bus says, in words: one line, for a person who reads a log.
#pragma once

#include <string>

#include "can/canlog/log.hpp"
#include "can/canlog/network.hpp"

namespace kenaf::canlog {

// "NMT start flipper rear left", "track left: operation enabled, position 1234 counts (0.0034 m)". By the frame alone,
// whatever came before; of a frame that is not what its identifier promises it says so.
std::string describe(const canopen::Frame& frame, const Network& network);
// And of lines that are no data frames what they are.
std::string describe(const LogFrame& logged, const Network& network);

}  // namespace kenaf::canlog
