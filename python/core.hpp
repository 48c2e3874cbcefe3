// The parts of the extension module _core, which the Python files of the package wrap. Each adds its functions; call
// with the GIL.
#pragma once

#include <pybind11/pybind11.h>

namespace kenaf::python {

void add_runs(pybind11::module_& module);
void add_simulate(pybind11::module_& module);
void add_diagnose(pybind11::module_& module);

}  // namespace kenaf::python
