// A piece of work that any of several threads may ask for, that one of them does at a time, and for which none waits.
#pragma once

#include <atomic>
#include <cstdint>

namespace kenaf::relayd {

class OneAtATime {
 public:
  // Calls work() on this thread, again and again until nobody has asked since it last began. Returns at once if another
  // thread is at it, which then calls it once more. What the caller did before is visible to that call.
  template <class Work>
  void ask(Work&& work) {
    if (asked_.fetch_add(1) != 0) return;
    for (std::uint32_t answered = 1; answered != 0;) {
      work();
      answered = asked_.fetch_sub(answered) - answered;  // what was asked meanwhile
    }
  }

 private:
  std::atomic<std::uint32_t> asked_{0};
};

}  // namespace kenaf::relayd
