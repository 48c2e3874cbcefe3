// The parts of the modules kenaf.hrt_sim and kenaf.hrt_real: hrt.h (include/kenaf/hrt.h) for Python. One source, linked
// with either library. Functions need the GIL unless they say otherwise.
#pragma once

#include <pybind11/pybind11.h>

#include "kenaf/hrt.h"

namespace kenaf::python {

// Types are local to their module, so that both modules can be in one process.
void add_errors(pybind11::module_& module);
void add_config(pybind11::module_& module);
void add_state(pybind11::module_& module);
void add_pictures(pybind11::module_& module);

// Raises the module's exception for a return value other than HRT_OK, with hrt_last_error() as its text. Must run on
// the thread on which the call failed.
void raise_unless_ok(int result);
// The same with another text.
[[noreturn]] void raise(int result, const char* text);

// Calls an hrt_ function that does not block, with the GIL held.
template <typename Function, typename... Arguments>
void call(Function function, Arguments... arguments) {
  raise_unless_ok(function(arguments...));
}

// Calls an hrt_ function that may block, without the GIL, and returns its result.
template <typename Function, typename... Arguments>
int without_gil(Function function, Arguments... arguments) {
  const pybind11::gil_scoped_release others_may_run;
  return function(arguments...);
}

}  // namespace kenaf::python
