// The extension module _core. The package's Python files are its only caller, and have the documentation.
#include "formats/description/description_error.hpp"
#include "formats/runs/run_file.hpp"
#include "formats/settings/environment.hpp"
#include "python/core.hpp"

PYBIND11_MODULE(_core, module) {
  namespace py = pybind11;
  if (const std::string wrong = kenaf::settings::wrong_variable(kenaf::settings::own_environment()); !wrong.empty())
    throw py::import_error(wrong);
  const py::exception<kenaf::runs::RunFileError> input_error(module, "InputError", PyExc_ValueError);
  input_error.attr("__module__") = "kenaf";  // where users find it
  // NOLINTNEXTLINE(performance-unnecessary-value-param): the type that pybind11 asks for
  py::register_exception_translator([](std::exception_ptr raised) {
    const py::object type = py::module_::import("kenaf._core").attr("InputError");
    try {
      if (raised) std::rethrow_exception(raised);
    } catch (const kenaf::runs::RunFileError& error) {
      PyErr_SetString(type.ptr(), error.what());
    } catch (const kenaf::description::DescriptionError& error) {
      PyErr_SetString(type.ptr(), error.what());
    }
  });
  kenaf::python::add_runs(module);
  kenaf::python::add_simulate(module);
  kenaf::python::add_diagnose(module);
}
