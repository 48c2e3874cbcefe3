// Estimates how fast two clocks drift apart, from the offsets of parts of the time during which both saw the robot.
//
// Each part's offset is refined by itself, from its neighbour's, outwards from the middle; a line through them, by
// least squares with inverse-variance weights, has the drift as its slope. Its standard error is scaled by the Birge
// ratio where the parts scatter beyond their errors.
//
// Thread safety: pure functions.
#pragma once

#include <optional>
#include <vector>

#include "gap/logs/clock_offset.hpp"

namespace kenaf::gap::logs {

struct ClockDrift {
  double rate = 0;            // growth of the offset (robot's time less the other's) for a second of robot's time
  double standard_error = 0;  // of the rate
  double offset_s = 0;        // at `at_s`
  double at_s = 0;            // robot's time
};

// Returns nothing where the drift is not proven: less than 20 s in common, fewer than three parts with an offset, a
// rate below three standard errors, or one that moves no end of the common time by 2 ms. `offset` is of the whole time,
// by the same courses.
std::optional<ClockDrift> estimate_clock_drift(const std::vector<CourseSeenTwice>& courses, const ClockOffset& offset);

}  // namespace kenaf::gap::logs
