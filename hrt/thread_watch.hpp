// What a thread of the program does while robot time waits for it. On a busy machine a thread may wait for a processor
// for as long as it likes: that is no doing of the program's, and must not change its run.
#pragma once

#include <sys/types.h>

#include <optional>
#include <string_view>

namespace kenaf::hrt {

// A thread as the kernel sees it.
struct ThreadLook {
  bool asleep;   // waits for something other than a processor or a disk
  double cpu_s;  // that it used so far, in steps of 10 ms
};

// `stat`: a line of /proc/PID/task/TID/stat (proc(5)). nullopt where it is none.
std::optional<ThreadLook> read_thread_stat(std::string_view stat);

// Of a thread of this process, by gettid(). nullopt: it has ended, or /proc is not there.
std::optional<ThreadLook> look_at_thread(pid_t thread);

// Counts the time that passes by a thread's own doing: asleep or at work. A value; times in seconds.
class ThreadWatch {
 public:
  // Of the time between two looks at most so much is counted as slept: the one who looks was late itself then.
  static constexpr double kLongestLook_s = 0.01;

  // The first look begins. A thread that cannot be looked at counts as asleep.
  void look(const std::optional<ThreadLook>& look, double wall_s);
  double spent_s() const { return spent_s_; }

 private:
  std::optional<double> wall_s_;  // of the look before
  double cpu_s_ = 0;
  double spent_s_ = 0;
};

}  // namespace kenaf::hrt
