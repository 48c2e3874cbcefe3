// From drives that are set up to drives that hold their position and obey, and back. In cycles: every step is one
// controlword in a PDO, so that heartbeat and supervision go on meanwhile.
#pragma once

#include <array>
#include <string>

#include "can/canbus/robot_bus.hpp"
#include "libkenaf_real/bus_cycle.hpp"

namespace kenaf::real {

// Enables all drives, each with the target to stay where it is (tracks: speed 0), and homes flippers that ask for it,
// which moves them. Faults that are left from before are reset. Throws hrt::Error(HRT_E_DEVICE) that names drive, state
// and error; whatever it throws, all are told to stop.
void power_up(BusCycle& cycle);

// Quick stop for all, in one cycle. Does not wait.
void quick_stop(BusCycle& cycle);
// The same for whoever has a worse error to tell than that the bus does not take it.
void try_quick_stop(BusCycle& cycle);

// One drive does not obey any more: the others stop before anything else is done. Throws hrt::Error(HRT_E_DEVICE) that
// names it and what is wrong, with the words of its emergency message, for which it waits some milliseconds.
[[noreturn]] void lose(BusCycle& cycle, std::size_t drive);

// Quick stop, told in each cycle until all drives show that they have left operation enabled and the tracks that they
// stand, 0.3 s at most. Those that do no longer watch for the master's heartbeat, and hold where they are; the others
// keep their watch, and so stop by themselves when the heartbeat ends. Returns these, in words; "" where there are
// none. Throws BusError.
std::string power_down(BusCycle& cycle);

}  // namespace kenaf::real
