#include "relayd/one_at_a_time.hpp"

#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <thread>
#include <vector>

namespace kenaf::relayd {

TEST_CASE("Work is done by whoever asks for it, and once more for all who ask while it is done") {
  OneAtATime work;
  int done = 0;
  work.ask([&] { ++done; });
  CHECK(done == 1);

  // three ask while the first is at it: it sees them all in one more turn
  done = 0;
  work.ask([&] {
    if (++done > 1) return;
    for (int i = 0; i < 3; ++i) work.ask([&] { done = 100; });
  });
  CHECK(done == 2);
}

TEST_CASE("However many threads ask, one works at a time, and nothing that was brought is left") {
  OneAtATime work;
  constexpr int kThreads = 4, kEach = 20000;
  std::atomic<int> brought = 0, at_work = 0;
  int taken = 0, most_at_work = 0;  // only touched by whoever works
  const auto take = [&] {
    most_at_work = std::max(most_at_work, ++at_work);
    taken += brought.exchange(0);
    --at_work;
  };
  std::vector<std::thread> threads;
  for (int i = 0; i < kThreads; ++i)
    threads.emplace_back([&] {
      for (int k = 0; k < kEach; ++k) {
        ++brought;
        work.ask(take);
      }
    });
  for (std::thread& thread : threads) thread.join();
  CHECK(taken == kThreads * kEach);
  CHECK(most_at_work == 1);
}

}  // namespace kenaf::relayd
