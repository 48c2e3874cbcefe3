// One exception class for each HRT_E_... value.
#include <array>
#include <string>

#include "python/hrt.hpp"

namespace kenaf::python {
namespace py = pybind11;
namespace {

struct ErrorClass {
  int code;
  const char* name;
};

constexpr std::array<ErrorClass, 13> kErrors{{
    {HRT_E_NOT_INITIALISED, "NotInitialised"},
    {HRT_E_BUSY, "Busy"},
    {HRT_E_ARGUMENT, "Argument"},
    {HRT_E_CONFIG, "Config"},
    {HRT_E_LINK, "Link"},
    {HRT_E_REFUSED, "Refused"},
    {HRT_E_TIMEOUT, "Timeout"},
    {HRT_E_STUCK, "Stuck"},
    {HRT_E_STOPPED, "Stopped"},
    {HRT_E_CLOSED, "Closed"},
    {HRT_E_DEVICE, "Device"},
    {HRT_E_RECORD, "Record"},
    {HRT_E_INTERNAL, "Internal"},
}};

std::string class_name(const ErrorClass& error) {
  return std::string(error.name) + "Error";
}

py::object this_module() {
  return py::module_::import(std::string("kenaf.hrt_").append(hrt_library()).c_str());
}

py::object new_exception(py::module_& module, const std::string& name, const py::tuple& bases) {
  const auto whole = module.attr("__name__").cast<std::string>() + "." + name;
  auto made = py::reinterpret_steal<py::object>(PyErr_NewException(whole.c_str(), bases.ptr(), nullptr));
  if (!made) throw py::error_already_set();
  module.attr(name.c_str()) = made;
  return made;
}

}  // namespace

void add_errors(py::module_& module) {
  const py::object base = new_exception(module, "Error", py::make_tuple(py::handle(PyExc_Exception)));
  base.attr("__doc__") = "A function of hrt.h failed. The text is that of hrt_last_error().";
  base.attr("code") = 0;
  for (const ErrorClass& error : kErrors) {
    // wrong arguments and late answers are also what Python calls them
    py::tuple bases = py::make_tuple(base);
    if (error.code == HRT_E_ARGUMENT) bases = py::make_tuple(base, py::handle(PyExc_ValueError));
    if (error.code == HRT_E_TIMEOUT) bases = py::make_tuple(base, py::handle(PyExc_TimeoutError));
    const py::object made = new_exception(module, class_name(error), bases);
    made.attr("__doc__") = std::string(hrt_error_name(error.code)) + " of hrt.h.";
    made.attr("code") = error.code;
  }
}

void raise_unless_ok(int result) {
  if (result != HRT_OK) raise(result, hrt_last_error());
}

void raise(int result, const char* text) {
  std::string name = "Error";
  for (const ErrorClass& error : kErrors)
    if (error.code == result) name = class_name(error);
  PyErr_SetString(this_module().attr(name.c_str()).ptr(), text);
  throw py::error_already_set();
}

}  // namespace kenaf::python
