// Real time as the description asks for it: what a system that forbids it is told to say, and that a system which
// allows it has the thread of the cycles, and no other, at that priority. Which of the two it is depends on who runs
// the test.
#include "libkenaf_real/real_time.hpp"

#include <pthread.h>
#include <sched.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cerrno>
#include <future>
#include <thread>

#include "hrt/error.hpp"
#include "tests/libkenaf_real/changed_robot.hpp"
#include "tests/libkenaf_real/robot_on_bus.hpp"

using namespace kenaf;
using namespace kenaf::real;

namespace {

int policy_now() {
  return sched_getscheduler(0) & ~SCHED_RESET_ON_FORK;
}
int policy_of_new_thread() {
  int policy = -1;
  std::thread([&] { policy = policy_now(); }).join();
  return policy;
}

}  // namespace

TEST_CASE("A refusal names key, limit and what to write where") {
  CHECK_THAT(refusal_of_priority(50, EPERM, 0),
             Catch::StartsWith("realtime_priority is 50 in [can]") && Catch::Contains("Operation not permitted") &&
                 Catch::Contains("no real-time priority (`ulimit -r`)") && Catch::Contains("`USER - rtprio 50`") &&
                 Catch::Contains("/etc/security/limits.d/kenaf.conf") && Catch::Contains("LimitRTPRIO=50"));
  CHECK_THAT(refusal_of_priority(50, EPERM, 20), Catch::Contains("real-time priorities up to 20"));
  CHECK_THAT(refusal_of_locking(EPERM, 8388608),
             Catch::StartsWith("lock_memory is true in [can]") && Catch::Contains("8192 KiB (`ulimit -l`)") &&
                 Catch::Contains("`USER - memlock unlimited`") && Catch::Contains("LimitMEMLOCK=infinity"));
  CHECK_THAT(refusal_of_locking(ENOMEM, RLIM_INFINITY), Catch::Contains("is unlimited (`ulimit -l`)"));
}

TEST_CASE("Opening and cycles run at the described priority, or the robot is not touched") {
  const std::string key = "interface = \"can0\"";
  const ChangedRobot changed({{key, key + "\nrealtime_priority = 3"}});
  RobotOnBus robot(changed.path());
  const int before = policy_now();
  try {
    robot.open();
  } catch (const hrt::Error& error) {
    CHECK(error.code() == HRT_E_CONFIG);
    CHECK_THAT(error.what(), Catch::StartsWith("realtime_priority is 3"));
    CHECK(robot.wire.log().empty());
    CHECK(policy_now() == before);
    return;
  }
  CHECK_THAT(robot.transport.setup(), Catch::EndsWith("cycles by SCHED_FIFO at priority 3, memory not locked"));
  // until the cycles have a thread of their own; what the opening starts meanwhile is not in real time
  CHECK(policy_now() == SCHED_FIFO);
  CHECK(policy_of_new_thread() == SCHED_OTHER);
  Scheduling cycle{};
  std::thread([&] {
    robot.transport.begin_cycles();
    cycle = scheduling_of_caller();
  }).join();
  CHECK((cycle.policy & ~SCHED_RESET_ON_FORK) == SCHED_FIFO);
  CHECK(cycle.parameter.sched_priority == 3);
  CHECK(policy_now() == before);
}

TEST_CASE("The thread of the cycles is at its priority before it has run") {
  const std::string key = "interface = \"can0\"";
  const ChangedRobot changed({{key, key + "\nrealtime_priority = 3"}});
  RobotOnBus robot(changed.path());
  try {
    robot.open();
  } catch (const hrt::Error&) {
    return;  // this system forbids real time
  }
  std::promise<void> go;
  std::thread cycles([&, may_go = go.get_future()]() mutable {
    may_go.get();
    robot.transport.begin_cycles();
  });
  robot.transport.prepare_cycles(cycles.native_handle());
  int policy = -1;
  sched_param parameter{};
  CHECK(pthread_getschedparam(cycles.native_handle(), &policy, &parameter) == 0);
  CHECK(policy == SCHED_FIFO);
  CHECK(parameter.sched_priority == 3);
  go.set_value();
  cycles.join();
}

TEST_CASE("A user without privileges, too, gets a thread's scheduling back after its real time") {
  canbus::RobotBus bus = canbus::load_robot_bus("kenaf");
  bus.realtime_priority = 3;
  std::thread([&] {
    const Scheduling before = scheduling_of_caller();
    try {
      begin_real_time(bus);
    } catch (const hrt::Error&) {
      return;  // this system forbids real time
    }
    constexpr int kNobody = 65534;
    syscall(SYS_setresuid, kNobody, kNobody, kNobody);  // of this thread alone; fails for who has no privileges
    give_back(before);
    CHECK(policy_now() == (before.policy & ~SCHED_RESET_ON_FORK));
  }).join();
}

TEST_CASE("An opening that fails, or is closed before its first cycle, gives its thread its scheduling back") {
  const std::string key = "interface = \"can0\"";
  const ChangedRobot changed({{key, key + "\nrealtime_priority = 3"}});
  const int before = policy_now();
  RobotOnBus dead(changed.path());
  dead.wire.inject({candrives::FaultKind::silent, 1});
  dead.config.can_timeout_s = 0.5;
  CHECK_THROWS_AS(dead.open(), hrt::Error);
  dead.transport.close();
  CHECK(policy_now() == before);
  RobotOnBus robot(changed.path());
  try {
    robot.open();
  } catch (const hrt::Error&) {
    return;  // this system forbids real time
  }
  robot.transport.close();
  CHECK(policy_now() == before);
}

TEST_CASE("Without the keys nothing is asked of the system") {
  RobotOnBus robot;
  const int before = policy_now();
  robot.open();
  CHECK_THAT(robot.transport.setup(), Catch::EndsWith("cycles by the usual scheduler, memory not locked"));
  CHECK(policy_now() == before);
  robot.transport.begin_cycles();
  CHECK(policy_now() == before);
}
