// Control-C during a call that blocks: the robot stops, and KeyboardInterrupt is raised.
#pragma once

#include <pybind11/pybind11.h>

#include "python/hrt.hpp"

namespace kenaf::python {

// While it lives, a SIGINT also stops the robot (hrt_stop), which ends a motion, and a second one closes it
// (hrt_close), which ends any other wait, such as for a paused simulation. Python's own handler is called as always.
// Does something only on the main thread and where Python handles SIGINT; elsewhere Python raises no KeyboardInterrupt
// either.
class StopOnInterrupt {
 public:
  StopOnInterrupt();
  ~StopOnInterrupt();
  StopOnInterrupt(const StopOnInterrupt&) = delete;
  StopOnInterrupt& operator=(const StopOnInterrupt&) = delete;

 private:
  bool active_ = false;
};

// Runs Python's handlers of the signals that have come, and throws what they raise. A KeyboardInterrupt leaves no robot
// that moves: also one that came between two calls, where no StopOnInterrupt lived.
void handle_signals();

// Calls an hrt_ function that blocks, without the GIL, and returns its result; signals wait for handle_signals().
template <typename Function, typename... Arguments>
int interruptible(Function function, Arguments... arguments) {
  const StopOnInterrupt stop;
  return without_gil(function, arguments...);
}

// Raises what a signal handler raised meanwhile, or else what raise_unless_ok() does.
template <typename Function, typename... Arguments>
void call_blocking(Function function, Arguments... arguments) {
  const int result = interruptible(function, arguments...);
  handle_signals();
  raise_unless_ok(result);
}

// hrt_sleep(), which hrt_stop() does not end, in parts between which signals are handled. Ends at the same cycle.
void sleep_interruptibly(double seconds);

}  // namespace kenaf::python
