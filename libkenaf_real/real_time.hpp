// Real time for the thread of the cycles, where the robot's description asks for it: SCHED_FIFO (sched(7)), before
// which no usual thread runs, and memory that is never swapped out (mlockall(2)).
//
// What the system does not allow is an error of the opening, not a warning: who asks for real time has a robot that
// needs it, and a cycle that is late only where the computer is busy shows when it is too late.
//
// Thread safety: any thread.
#pragma once

#include <sched.h>
#include <sys/resource.h>
#include <sys/types.h>

#include <string>
#include <thread>

#include "can/canbus/robot_bus.hpp"

namespace kenaf::real {

// Before anything is sent to the robot: locks the memory of the process, from now on and until it ends, and tries the
// priority in a thread of its own, so that a refusal costs nothing. Throws hrt::Error(HRT_E_CONFIG) with what to set.
void check_real_time(const canbus::RobotBus& bus);

// Scheduling of a thread, to be given back to it.
struct Scheduling {
  pid_t thread;  // gettid()
  int policy;
  sched_param parameter;
};
Scheduling scheduling_of_caller();
void give_back(const Scheduling& scheduling);  // a thread that has ended needs it no more

// For the calling thread: the one of the cycles, and before it the one that opens the robot, since drives that are
// enabled miss their commands in a late opening too. Threads that it starts do not inherit it. Throws as
// check_real_time().
void begin_real_time(const canbus::RobotBus& bus);

// The same for a thread that was just made: until it has run, it cannot do so itself, and on a computer busy with more
// urgent threads than the usual ones it would first have to wait for a processor. Threads that it starts inherit the
// priority until it has called the function above.
void begin_real_time(std::thread::native_handle_type thread, const canbus::RobotBus& bus);

// "cycles by SCHED_FIFO at priority 50, memory locked".
std::string describe_real_time(const canbus::RobotBus& bus);

// What is wrong and what to do where the system has answered with `error` (errno). `limit`: RLIMIT_RTPRIO;
// RLIMIT_MEMLOCK in bytes.
std::string refusal_of_priority(int priority, int error, rlim_t limit);
std::string refusal_of_locking(int error, rlim_t limit);

}  // namespace kenaf::real
