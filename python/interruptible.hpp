// Long calculations that Control-C ends.
#pragma once

#include <atomic>
#include <functional>

namespace kenaf::python {

// Calls work(stop) on a thread of its own, without the GIL, while this one handles Python's signals. When a handler
// raises, sets `stop`, waits for `work` to return, and throws pybind11::error_already_set. Otherwise rethrows what
// `work` throws. `while_waiting` is called some ten times a second, with the GIL; what it raises stops the work
// likewise. Call with the GIL.
void run_interruptibly(const std::function<void(const std::atomic<bool>& stop)>& work,
                       const std::function<void()>& while_waiting = {});

}  // namespace kenaf::python
