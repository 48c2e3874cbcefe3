// When a frame was received, on a clock that never goes back, from the kernel's time stamp, which is of the wall clock.
//
// Only a frame's age is taken from the wall clock, for it may be set while the program runs (NTP, an operator): an age
// that spans such a step is wrong by the step, and a robot that believes it finds its drives silent.
#pragma once

#include <optional>

#include "can/canopen/frame.hpp"

namespace kenaf::canbus {

struct WallClock {
  std::optional<canopen::Time> ahead;   // of the other clock, when it was looked at last
  std::optional<canopen::Time> set_at;  // when it was last seen to have been set, on the other clock
};

// `stamp`: the frame's, of the wall clock; `wall_now` and `now`: both clocks at one moment. A stamp that says nothing
// (ahead of the clock, more than a second old, from before the clock was set) is as good as none: `now`.
canopen::Time received_at(WallClock& clock, canopen::Time stamp, canopen::Time wall_now, canopen::Time now);

}  // namespace kenaf::canbus
