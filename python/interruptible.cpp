#include "python/interruptible.hpp"

#include <pybind11/pybind11.h>

#include <chrono>
#include <exception>
#include <future>
#include <utility>

namespace kenaf::python {
namespace py = pybind11;
namespace {

constexpr auto kBetween = std::chrono::milliseconds(100);  // a person waits that long without noticing

// Waits without the GIL; true: the work is done.
bool is_done(const std::future<void>& result) {
  const py::gil_scoped_release others_may_run;
  return result.wait_for(kBetween) == std::future_status::ready;
}

}  // namespace

void run_interruptibly(const std::function<void(const std::atomic<bool>&)>& work,
                       const std::function<void()>& while_waiting) {
  std::atomic<bool> stop = false;
  std::future<void> result = std::async(std::launch::async, [&] { work(stop); });
  try {
    while (!is_done(result)) {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      if (while_waiting) while_waiting();
    }
  } catch (...) {
    const std::exception_ptr raised = std::current_exception();
    stop = true;
    {
      const py::gil_scoped_release others_may_run;
      result.wait();
    }
    std::rethrow_exception(raised);
  }
  result.get();
}

}  // namespace kenaf::python
