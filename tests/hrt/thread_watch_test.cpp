// Which time is a program's own, and which is the machine's.
#include "hrt/thread_watch.hpp"

#include <unistd.h>

#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <string>
#include <thread>

using namespace kenaf::hrt;
using namespace std::chrono_literals;

namespace {

const std::string kBefore = " 1 2 3 4 5 6 7 8 9 10 ";  // the ten fields between state and user time

}  // namespace

TEST_CASE("A line of stat: state, and user and system time in ticks") {
  const double tick_s = 1.0 / static_cast<double>(sysconf(_SC_CLK_TCK));
  const auto asleep = read_thread_stat("42 (square_sim) S" + kBefore + "7 5 0 0");
  REQUIRE(asleep);
  CHECK(asleep->asleep);
  CHECK(asleep->cpu_s == Approx(12 * tick_s));
  CHECK_FALSE(read_thread_stat("42 (square_sim) R" + kBefore + "7 5 0 0")->asleep);  // runs, or is to run
  CHECK_FALSE(read_thread_stat("42 (square_sim) D" + kBefore + "7 5 0 0")->asleep);  // waits for a disk
  CHECK_FALSE(read_thread_stat("42 (a) S (b) R" + kBefore + "7 5 0 0")->asleep);     // a name that looks like a state
  for (const std::string& broken : {std::string(), std::string("42 (x"), std::string("42 (x) "),
                                    std::string("42 (x) S 1 2"), "42 (x) S" + kBefore + "a 5"}) {
    CHECK_FALSE(read_thread_stat(broken));
  }
}

TEST_CASE("A thread that waits for a processor spends nothing, one that works spends what it works") {
  ThreadWatch watch;
  watch.look(ThreadLook{false, 1.00}, 10);
  watch.look(ThreadLook{false, 1.00}, 11);  // a second without a processor
  CHECK(watch.spent_s() == 0);
  watch.look(ThreadLook{false, 1.02}, 12);
  CHECK(watch.spent_s() == Approx(0.02));
}

TEST_CASE("A thread that sleeps spends the time that was watched, and no more") {
  ThreadWatch watch;
  watch.look(ThreadLook{true, 0}, 10);
  CHECK(watch.spent_s() == 0);
  watch.look(ThreadLook{true, 0}, 10.005);
  CHECK(watch.spent_s() == Approx(0.005));
  watch.look(ThreadLook{true, 0}, 20);  // who looked had no processor for ten seconds
  CHECK(watch.spent_s() == Approx(0.005 + ThreadWatch::kLongestLook_s));
  watch.look(std::nullopt, 20.005);  // ended
  CHECK(watch.spent_s() == Approx(0.01 + ThreadWatch::kLongestLook_s));
}

TEST_CASE("Threads of this process are seen as they are") {
  CHECK_FALSE(look_at_thread(gettid())->asleep);
  std::atomic<pid_t> sleeper = 0;
  std::atomic<bool> wakes = false;
  std::thread thread([&] {
    sleeper = gettid();
    wakes.wait(false);
  });
  while (sleeper == 0 || !look_at_thread(sleeper)->asleep) std::this_thread::sleep_for(1ms);
  wakes = true;
  wakes.notify_one();
  thread.join();
  while (look_at_thread(sleeper)) std::this_thread::sleep_for(1ms);  // gone
}
