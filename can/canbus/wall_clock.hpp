// Time of reception on a monotonic clock, from the kernel's time stamp, which is wall-clock time.
//
// Only a frame's age is taken from the wall clock, because the clock may be set while the program runs (NTP, an
// operator): an age across such a step is wrong by the step, and would make drives seem silent.
#pragma once

#include <optional>

#include "can/canopen/frame.hpp"

namespace kenaf::canbus {

struct WallClock {
  std::optional<canopen::Time> ahead;   // lead over the other clock at the last look
  std::optional<canopen::Time> set_at;  // last time at which a step was detected, on the other clock
};

// `stamp`: the frame's, wall clock; `wall_now` and `now`: both clocks at one moment. Returns `now` for an implausible
// stamp (in the future, more than a second old, from before the clock was set).
canopen::Time received_at(WallClock& clock, canopen::Time stamp, canopen::Time wall_now, canopen::Time now);

}  // namespace kenaf::canbus
