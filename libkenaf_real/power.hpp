// From drives that are set up to drives that hold their position and obey, and back. In cycles: every step is one controlword
// in a PDO, so that heartbeat and supervision go on meanwhile.
#pragma once

#include <array>

#include "canbus/robot_bus.hpp"
#include "libkenaf_real/bus_cycle.hpp"

namespace kenaf::real {

// Enables all drives, each with the target to stay where it is (tracks: speed 0), and homes flippers that ask for it, which
// moves them. Faults that are left from before are reset. Throws hrt::Error(HRT_E_DEVICE) that names drive, state and error.
void power_up(BusCycle& cycle);

// Quick stop for all, in one cycle. Does not wait.
void quick_stop(BusCycle& cycle);

// Quick stop; waits until the tracks stand, 0.3 s at most; then the drives no longer watch for the master's heartbeat, and
// hold where they are. What fails is passed over: the drives stop by themselves when the heartbeat ends.
void power_down(BusCycle& cycle);

}  // namespace kenaf::real
