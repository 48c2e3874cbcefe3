// How long the computer was suspended (suspend to RAM, to disk, or to idle), from two clocks of the kernel that differ
// by that alone: CLOCK_BOOTTIME counts it, CLOCK_MONOTONIC stands still. clock_gettime(2).
//
// No two clocks can be read at one moment, and a thread may wait for a processor between them. So the reading of the
// first is kept between two of the other: what cannot be a wait must be a suspend.
//
// Thread safety: a value.
#pragma once

#include <optional>

#include "can/canopen/frame.hpp"

namespace kenaf::canbus {

struct SuspendWatch {
  std::optional<canopen::Time> most_ahead;  // lead of the boot clock before any suspend: not more than this
  canopen::Time suspended{};                // since the first look, by what is certain
};

// One look at the clocks, read in this order: `before` and `after` monotonic, `boot` between them. Returns how long the
// computer was suspended since the first look: never too much, and exactly so but for the time between the readings.
canopen::Time suspended_since(SuspendWatch& watch, canopen::Time before, canopen::Time boot, canopen::Time after);

}  // namespace kenaf::canbus
