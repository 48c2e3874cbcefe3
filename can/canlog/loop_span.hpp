// The stretches of a log in which the robot is driven: from the first motion command to the last, for each time that
// the nodes were set up.
#pragma once

#include <vector>

#include "can/canlog/log.hpp"
#include "can/canlog/network.hpp"

namespace kenaf::canlog {

// Indices into log.frames, both inclusive.
struct LoopSpan {
  std::size_t first, last;
};

// A motion command is a speed other than 0 for a track, a new set-point for a flipper in profile position mode, or
// another position in cyclic position mode, to an enabled drive. Homing belongs to the set-up and does not count.
std::vector<LoopSpan> loop_spans(const Log& log, const Network& network);

}  // namespace kenaf::canlog
