// The time that the calling thread has had on a processor: other load on the machine does not count.
//
// Thread safety: any thread.
#pragma once

#include <time.h>

namespace kenaf::bench {

inline double thread_time_s() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

}  // namespace kenaf::bench
