// Real time as the description asks for it: what a system that forbids it is told to say, and that a system which
// allows it has the thread of the cycles, and no other, at that priority. Which of the two it is depends on who runs
// the test.
#include "libkenaf_real/real_time.hpp"

#include <pthread.h>
#include <sched.h>

#include <catch2/catch.hpp>
#include <cerrno>
#include <thread>

#include "hrt/error.hpp"
#include "tests/libkenaf_real/changed_robot.hpp"
#include "tests/libkenaf_real/robot_on_bus.hpp"

using namespace kenaf;
using namespace kenaf::real;

namespace {

struct Scheduling {
  int policy, priority;
};
Scheduling scheduling_now() {
  int policy = 0;
  sched_param parameter{};
  REQUIRE(pthread_getschedparam(pthread_self(), &policy, &parameter) == 0);
  return {policy, parameter.sched_priority};
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

TEST_CASE("The thread of the cycles runs at the described priority, or the robot is not touched") {
  const std::string key = "interface = \"can0\"";
  const ChangedRobot changed({{key, key + "\nrealtime_priority = 3"}});
  RobotOnBus robot(changed.path());
  const Scheduling before = scheduling_now();
  try {
    robot.open();
  } catch (const hrt::Error& error) {
    CHECK(error.code() == HRT_E_CONFIG);
    CHECK_THAT(error.what(), Catch::StartsWith("realtime_priority is 3"));
    CHECK(robot.wire.log().empty());
    return;
  }
  CHECK_THAT(robot.transport.setup(), Catch::EndsWith("cycles by SCHED_FIFO at priority 3, memory not locked"));
  CHECK(scheduling_now().policy == before.policy);
  Scheduling cycle{};
  std::thread([&] {
    robot.transport.begin_cycles();
    cycle = scheduling_now();
  }).join();
  CHECK(cycle.policy == SCHED_FIFO);
  CHECK(cycle.priority == 3);
  CHECK(scheduling_now().policy == before.policy);
}

TEST_CASE("Without the keys nothing is asked of the system") {
  RobotOnBus robot;
  robot.open();
  CHECK_THAT(robot.transport.setup(), Catch::EndsWith("cycles by the usual scheduler, memory not locked"));
  const Scheduling before = scheduling_now();
  robot.transport.begin_cycles();
  CHECK(scheduling_now().policy == before.policy);
  CHECK(scheduling_now().priority == before.priority);
}
