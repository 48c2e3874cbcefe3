// The two watches by which a drive stops by itself when its master is gone: its consumer of the master's heartbeat
// (0x1016; node guarding, 0x100D, where its device file says so), and the event timer of its commands (0x1400:05). CiA
// 301, 7.2.8.2.2 and 7.5.2.35. Both are optional in CiA 301; a drive with neither would go on when this program dies,
// and is refused.
//
//   heartbeat     ends with the program; begins during the set-up
//   event timer   ends with the commands, also of a program whose heartbeat goes on; begins when every cycle has
//                 commands, since the SDO transfers of the set-up leave gaps
//
// What a drive does where a watch expires is its abort connection option (0x6007) by CiA 402-2 for the heartbeat, and
// its maker's choice for the event timer: most do the same.
#pragma once

#include <string>
#include <vector>

#include "can/canbus/robot_bus.hpp"
#include "libkenaf_real/bus_cycle.hpp"

namespace kenaf::real {

struct DriveWatches {
  bool heartbeat = false, event_timer = false;
};
using AllWatches = std::vector<DriveWatches>;  // of RobotBus::drives

// How long a drive's commands may stay away: master_silence_s, but three of them at least, so that a lost frame stops
// nothing.
double longest_command_gap_s(const canbus::RobotBus& bus, std::size_t drive, double period_s);

// In the set-up of a drive that is not enabled: begins its watch of the heartbeat, and looks for its event timer.
// Throws hrt::Error(HRT_E_DEVICE) if it has no watch, or not those that the description requires, or only one that
// would stop the robot later than can.stop_within_s.
DriveWatches find_watches(Master& master, const canbus::RobotBus& bus, std::size_t drive, double period_s);

// Begins the event timers, with a cycle after each drive: enabled drives stay where they are. A timer that refuses its
// value becomes one that is not there.
void begin_event_timers(BusCycle& cycle, AllWatches& watches, double period_s);

// Drives that have stopped may hold their position without a master. One that refuses this is at rest all the same; its
// reaction to the end of heartbeat and commands is then as before. The event timers end first, flippers' before all,
// with a cycle of the orders `meanwhile` after each: a timer that runs out while others are ended would be a fault to
// some drives, and a flipper in fault no longer carries the robot. Ends with a cycle that shows all states.
void end_watches(BusCycle& cycle, const std::vector<std::size_t>& drives, const DriveOrders& meanwhile);

// Says of each drive, a line each, which watches it has and how long they wait.
std::string describe_watches(const canbus::RobotBus& bus, const AllWatches& watches, double period_s);
// Names the drives that have one watch only, unless the description says so; "": none.
std::string warning_of_watches(const canbus::RobotBus& bus, const AllWatches& watches);

}  // namespace kenaf::real
