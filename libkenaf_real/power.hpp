// From configured drives to drives that hold their position and obey, and back. Runs in cycles: every step is one
// controlword in a PDO, so that heartbeat and supervision continue meanwhile.
#pragma once

#include <string>

#include "can/canbus/robot_bus.hpp"
#include "libkenaf_real/bus_cycle.hpp"

namespace kenaf::real {

// Enables all drives, each with the target to stay where it is (tracks: speed 0), and homes flippers that require it,
// which moves them. Resets earlier faults. Throws hrt::Error(HRT_E_DEVICE) naming drive, state and error; on any
// exception all drives are commanded to stop.
void power_up(BusCycle& cycle);

// Quick stop of all drives, in one cycle. Does not wait, not even for the turn of drives that take few commands.
void quick_stop(BusCycle& cycle);
// The same, ignoring a bus that refuses it: for callers with a more important error to report.
void try_quick_stop(BusCycle& cycle);

// One drive no longer obeys: stops the others before anything else. Throws hrt::Error(HRT_E_DEVICE) naming it and the
// cause, with the text of its emergency message, for which it waits some milliseconds.
[[noreturn]] void lose(BusCycle& cycle, std::size_t drive);

// Drives after power_down, named; "": none.
struct NotHeld {
  std::string running;         // not seen to stop
  std::string without_torque;  // at rest, but no longer holding their position
};

// Commands quick stop in each cycle until all drives show that they have left operation enabled and the tracks that
// they stand, for as long as the robot's longest stop takes, and 0.3 s at least. Drives that have done so stop watching
// the master's heartbeat and commands and hold their position; the others keep watching, and so stop by themselves when
// these end. Throws BusError.
NotHeld power_down(BusCycle& cycle);

}  // namespace kenaf::real
