// The stretches of a log in which the robot is driven: from the first order to move to the last, for each time that the
// nodes were set up.
#pragma once

#include <vector>

#include "can/canlog/log.hpp"
#include "can/canlog/network.hpp"

namespace kenaf::canlog {

// Numbers of frames in log.frames, both ends within.
struct LoopSpan {
  std::size_t first, last;
};

// An order to move: a speed other than 0 for a track; a new set-point for a flipper in profile position mode, another
// position in cyclic position mode; of drives that are enabled. Homing, which belongs to the set-up, is none.
std::vector<LoopSpan> loop_spans(const Log& log, const Network& network);

}  // namespace kenaf::canlog
