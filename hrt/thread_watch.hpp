// Activity of a program's thread while robot time waits for it. On a busy machine a thread may wait for a processor for
// any time: the program does not cause that, and it must not change its run.
#pragma once

#include <sys/types.h>

#include <optional>
#include <string_view>

namespace kenaf::hrt {

// State of a thread as the kernel reports it.
struct ThreadLook {
  bool asleep;   // waits for something other than a processor or a disk
  double cpu_s;  // used so far, in steps of 10 ms
};

// `stat`: a line of /proc/PID/task/TID/stat (proc(5)). nullopt if it is none.
std::optional<ThreadLook> read_thread_stat(std::string_view stat);

// Reads the state of a thread of this process, by gettid(). nullopt if it has ended or there is no /proc.
std::optional<ThreadLook> look_at_thread(pid_t thread);

// Counts the time that passes by a thread's own doing: asleep or working. A value; times in seconds.
class ThreadWatch {
 public:
  // At most this much of the time between two looks counts as slept: beyond it, the watching thread itself was late.
  static constexpr double kLongestLook_s = 0.01;

  // The first look starts the count. A thread that cannot be examined counts as asleep.
  void look(const std::optional<ThreadLook>& look, double wall_s);
  double spent_s() const { return spent_s_; }

 private:
  std::optional<double> wall_s_;  // of the previous look
  double cpu_s_ = 0;
  double spent_s_ = 0;
};

}  // namespace kenaf::hrt
