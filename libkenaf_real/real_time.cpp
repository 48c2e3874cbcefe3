#include "libkenaf_real/real_time.hpp"

#include <fmt/format.h>
#include <linux/capability.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <exception>
#include <system_error>
#include <thread>

#include "hrt/error.hpp"

namespace kenaf::real {
namespace {

using hrt::Error;

rlim_t soft_limit(__rlimit_resource resource) {
  rlimit limit{};
  return getrlimit(resource, &limit) == 0 ? limit.rlim_cur : 0;
}

std::string in_words(int error) {
  return std::generic_category().message(error);
}

void set_priority(int priority) {
  // 0: of the calling thread. pthread_setschedparam() has no flag by which new threads do not inherit.
  const sched_param parameter{.sched_priority = priority};
  if (sched_setscheduler(0, SCHED_FIFO | SCHED_RESET_ON_FORK, &parameter) == 0) return;
  throw Error(HRT_E_CONFIG, refusal_of_priority(priority, errno, soft_limit(RLIMIT_RTPRIO)));
}

bool may_lock_all() {
  __user_cap_header_struct header{.version = _LINUX_CAPABILITY_VERSION_3, .pid = 0};
  std::array<__user_cap_data_struct, _LINUX_CAPABILITY_U32S_3> data{};
  if (syscall(SYS_capget, &header, data.data()) != 0) return false;
  return (data[CAP_TO_INDEX(CAP_IPC_LOCK)].effective & CAP_TO_MASK(CAP_IPC_LOCK)) != 0;
}

void lock_memory() {
  // Below a limit the lock may hold now, and the program's next allocation fail: so only without one.
  const rlim_t limit = soft_limit(RLIMIT_MEMLOCK);
  int error = limit == RLIM_INFINITY || may_lock_all() ? 0 : EPERM;
  if (error == 0 && mlockall(MCL_CURRENT | MCL_FUTURE) != 0) error = errno;
  if (error != 0) throw Error(HRT_E_CONFIG, refusal_of_locking(error, limit));
}

}  // namespace

std::string refusal_of_priority(int priority, int error, rlim_t limit) {
  const std::string allowed =
      limit == 0 ? "no real-time priority" : fmt::format("real-time priorities up to {}", limit);
  return fmt::format(
      "realtime_priority is {0} in [can] of the robot's description, but the system refuses SCHED_FIFO at that "
      "priority "
      "({1}): this user is allowed {2} (`ulimit -r`). A line `USER - rtprio {0}` in /etc/security/limits.d/kenaf.conf "
      "and "
      "a new login allow it, in a service LimitRTPRIO={0}, or CAP_SYS_NICE; without the key the robot runs without "
      "real "
      "time",
      priority, in_words(error), allowed);
}

std::string refusal_of_locking(int error, rlim_t limit) {
  return fmt::format(
      "lock_memory is true in [can] of the robot's description, but the system does not allow the whole memory to be "
      "locked ({0}): the limit of this user is {1} (`ulimit -l`). A line `USER - memlock unlimited` in "
      "/etc/security/limits.d/kenaf.conf and a new login allow it, in a service LimitMEMLOCK=infinity, or "
      "CAP_IPC_LOCK; "
      "without the key the robot runs with memory that may be swapped out",
      in_words(error), limit == RLIM_INFINITY ? "unlimited" : fmt::format("{} KiB", limit / 1024));
}

void check_real_time(const canbus::RobotBus& bus) {
  if (bus.lock_memory) lock_memory();
  if (!bus.realtime_priority) return;
  std::exception_ptr refused;
  std::thread([&] {
    try {
      set_priority(*bus.realtime_priority);
    } catch (...) {
      refused = std::current_exception();
    }
  }).join();
  if (refused) std::rethrow_exception(refused);
}

Scheduling scheduling_of_caller() {
  Scheduling scheduling{.thread = gettid(), .policy = sched_getscheduler(0), .parameter = {}};
  sched_getparam(0, &scheduling.parameter);
  return scheduling;
}

void give_back(const Scheduling& scheduling) {
  // Without CAP_SYS_NICE the flag by which new threads do not inherit stays: the thread is a usual one all the same.
  if (sched_setscheduler(scheduling.thread, scheduling.policy, &scheduling.parameter) != 0)
    sched_setscheduler(scheduling.thread, scheduling.policy | SCHED_RESET_ON_FORK, &scheduling.parameter);
}

void begin_real_time(const canbus::RobotBus& bus) {
  if (bus.realtime_priority) set_priority(*bus.realtime_priority);
}

void begin_real_time(std::thread::native_handle_type thread, const canbus::RobotBus& bus) {
  if (!bus.realtime_priority) return;
  const sched_param parameter{.sched_priority = *bus.realtime_priority};
  const int error = pthread_setschedparam(thread, SCHED_FIFO, &parameter);
  if (error != 0)
    throw Error(HRT_E_CONFIG, refusal_of_priority(*bus.realtime_priority, error, soft_limit(RLIMIT_RTPRIO)));
}

std::string describe_real_time(const canbus::RobotBus& bus) {
  return fmt::format(
      "cycles by {}, memory {}",
      bus.realtime_priority ? fmt::format("SCHED_FIFO at priority {}", *bus.realtime_priority) : "the usual scheduler",
      bus.lock_memory ? "locked" : "not locked");
}

}  // namespace kenaf::real
